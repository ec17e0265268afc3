# SPDX-License-Identifier: GPL-3.0-or-later
"""Which frames are fitted, which validate, and where in a window particles are marked anew."""

from dataclasses import dataclass

from bedchain.errors import UserError

# of the learning window; the paper's 10-15 s is fitted on 10-13.5 s and validated on 13.5-15 s
FIT_SHARE = 0.7
# more starts than this cost time and say little more: a window holds only so many bubbles
MOST_STARTS = 5


@dataclass(frozen=True)
class Start:
    """Where particles are marked, and how far they are followed.

    Parameters
    ----------
    run : int
        Number of the run, 0 for the one learned from.
    number : int
        Number of the start in its window; 0 is the window's first frame.
    frame, last : int
        Frames of the run: the start, and the last one looked at.
    """

    run: int
    number: int
    frame: int
    last: int

    @property
    def length(self) -> int:
        """Frames after the start [1]."""
        return self.last - self.frame


def split(learning: slice) -> tuple[slice, slice]:
    """Cut the learning window into a part to fit and a later part to validate.

    Parameters
    ----------
    learning : slice
        Frames of the window.

    Returns
    -------
    fit, validation : slice
        The last frame fitted is the first start of the validation.

    Raises
    ------
    UserError
        Fewer than two frame intervals are left for a part.
    """
    intervals = learning.stop - learning.start - 1
    cut = learning.start + round(FIT_SHARE * intervals)
    if min(cut - learning.start, learning.stop - 1 - cut) < 2:
        raise UserError(
            f"the learning window holds {intervals + 1} frames, too few to fit on {FIT_SHARE:.0%} of them "
            "and validate on the rest: lengthen learning, or write frames more often"
        )
    return slice(learning.start, cut + 1), slice(cut, learning.stop)


def starts_in(part: slice, spacing: int, run: int = 0) -> list[Start]:
    """Starts in the first half of a window, each followed to its end.

    Parameters
    ----------
    part : slice
        Frames of the window.
    spacing : int
        Least number of frames between starts: those of `memory`.
    run : int
        Number of the run.

    Returns
    -------
    list of Start
        At most `MOST_STARTS`, evenly spaced; the first is the window's first frame.
    """
    room = (part.stop - 1 - part.start) // 2
    number = min(MOST_STARTS, 1 + room // max(1, spacing))
    apart = room // (number - 1) if number > 1 else 0
    return [Start(run, k, part.start + k * apart, part.stop - 1) for k in range(number)]
