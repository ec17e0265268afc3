# SPDX-License-Identifier: GPL-3.0-or-later
"""Starts, the frames at which particles are marked, and the split of the learning window."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import UserError

# of the learning window; the paper's 10-15 s is fitted on 10-13.5 s and validated on 13.5-15 s
FIT_SHARE = 0.7
# a window holds few bubbles: more starts cost time and add little
MOST_STARTS = 5
# blocks of the learning window that are left out in turn
FOLDS = 5


@dataclass(frozen=True)
class Start:
    """A frame at which particles are marked, and the frame up to which they are followed.

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
    """The learning window, cut into a part to fit and a later part to validate.

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
        A part has fewer than two frame intervals.
    """
    intervals = learning.stop - learning.start - 1
    cut = learning.start + round(FIT_SHARE * intervals)
    if min(cut - learning.start, learning.stop - 1 - cut) < 2:
        raise UserError(
            f"the learning window holds {intervals + 1} frames, too few to fit on {FIT_SHARE:.0%} of them "
            "and validate on the rest: lengthen learning, or write frames more often"
        )
    return slice(learning.start, cut + 1), slice(cut, learning.stop)


def blocks_of(learning: slice) -> list[slice]:
    """The learning window in `FOLDS` blocks as equal as may be, each with both of its ends.

    Parameters
    ----------
    learning : slice
        Frames of the window.

    Returns
    -------
    list of slice
        The last frame of a block is the first of the next one.

    Raises
    ------
    UserError
        A block has fewer than two frame intervals.
    """
    intervals = learning.stop - 1 - learning.start
    if intervals < 2 * FOLDS:
        raise UserError(
            f"the learning window holds {intervals + 1} frames, too few to leave each of {FOLDS} blocks "
            "out in turn: lengthen learning, or write frames more often"
        )
    edges = [learning.start + round(number * intervals / FOLDS) for number in range(FOLDS + 1)]
    return [slice(start, end + 1) for start, end in zip(edges, edges[1:], strict=False)]


def steps_outside(block: slice, learning: slice, lag: int) -> NDArray[np.int64]:
    """Weight of each step in the learning window: 1 where it has no frame inside a block, else 0.

    Parameters
    ----------
    block, learning : slice
        Frames of the run; the ends of the block do not count as inside.
    lag : int
        Frames in a step.

    Returns
    -------
    (n_frames - lag,) int64 array
    """
    first = np.arange(learning.start, learning.stop - lag)
    return ((first + lag <= block.start) | (first >= block.stop - 1)).astype(np.int64)


def starts_in(part: slice, spacing: int, run: int = 0) -> list[Start]:
    """Starts in the first half of a window, each followed to its end.

    Parameters
    ----------
    part : slice
        Frames of the window.
    spacing : int
        Least number of frames between starts, as `bands.memory` gives it.
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
