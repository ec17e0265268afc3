# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames as physics: displacements between frames beside the velocities in them, interval by interval.

A particle moves by its velocity times the interval, as far as the velocity lasts that long. So the slope
of displacements against the mean velocity of both frames times the interval is near 1 for all intervals of a
sound series. Another number for all is a wrong time or length; one
interval apart from the others is a missing, a repeated or a foreign frame.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from bedchain.trajectory.frame_files import Entry

# of the slope of all intervals: velocities that turn within an interval lower it
SLOPE_RANGE = (0.5, 1.25)
# of an interval's slope over that of the series
JUMP_RANGE = (0.6, 1.6)
# share of the displacement that velocities explain, below which slopes mean nothing
FEWEST_EXPLAINED = 0.25
# of the correlation of the series, below which an interval does not follow its velocities
LOST_TOUCH = 0.5
REPEATED = 1e-3  # of the usual displacement


class Interval(NamedTuple):
    """Between two frames."""

    before: Entry
    after: Entry
    slope: float
    correlation: float
    displacement_m: float


class MotionCheck:
    """Displacements beside velocities of frames that are added in order of time.

    Parameters
    ----------
    periods_m : tuple of float
        Lengths along x and z after which the frames repeat [m], 0 where they do not: displacements are the
        short way.
    """

    def __init__(self, periods_m: tuple[float, float] = (0.0, 0.0)) -> None:
        self.intervals: list[Interval] = []
        self.periods_m = periods_m
        self._last: tuple[Entry, np.ndarray, np.ndarray] | None = None

    def add(self, entry: Entry, ids: np.ndarray, rows: np.ndarray) -> None:
        """Take the next frame.

        Parameters
        ----------
        entry : Entry
        ids : (n_particles,) ndarray
            Ascending.
        rows : (>= 4, n_particles) ndarray
            x, z [m], vx, vz [m/s], NaN where there are no velocities.
        """
        if self._last is not None:
            self.intervals.append(_interval(*self._last, entry, ids, rows, self.periods_m))
        self._last = entry, ids, rows

    def table(self) -> pd.DataFrame:
        """An interval a row: step, time_s, slope_1, correlation_1, displacement_m."""
        return pd.DataFrame(
            {
                "step": [part.after.step for part in self.intervals],
                "time_s": [part.after.time_s for part in self.intervals],
                "slope_1": [part.slope for part in self.intervals],
                "correlation_1": [part.correlation for part in self.intervals],
                "displacement_m": [part.displacement_m for part in self.intervals],
            }
        )

    def slope(self) -> float | None:
        """Median slope of the intervals; None where velocities explain too little of the displacements."""
        slopes = np.array([part.slope for part in self.intervals])
        moving = np.isfinite(slopes)
        if not moving.any() or self.explained() < FEWEST_EXPLAINED:
            return None
        slope = float(np.median(slopes[moving]))
        return slope if slope > 0 else None

    def explained(self) -> float:
        """Share of the displacements that velocities explain, the median of the intervals [1]."""
        touch = np.array([part.correlation for part in self.intervals])
        return float(np.median(touch[np.isfinite(touch)] ** 2)) if np.isfinite(touch).any() else 0.0

    def still(self, part: Interval) -> bool:
        """Whether hardly a particle moves in an interval, beside the others."""
        usual = float(np.median([other.displacement_m for other in self.intervals]))
        return part.displacement_m <= REPEATED * usual

    def moves(self, part: Interval) -> bool:
        """Whether an interval can be judged."""
        return bool(np.isfinite(part.slope)) and not self.still(part)

    def warnings(self) -> list[str]:
        """What is wrong with the series, each with its frame and factor; empty for a sound one."""
        messages = [_repeated(part) for part in self.intervals if self.still(part)]
        if not any(np.isfinite(part.correlation) for part in self.intervals):
            return messages
        slope = self.slope()
        if slope is None:
            return [*messages, _unrelated(self.explained())]
        if not SLOPE_RANGE[0] <= slope <= SLOPE_RANGE[1]:
            messages.append(_wrong_scale(slope))
        lost = {at - 1 for at in seams(self)}
        for at, part in enumerate(self.intervals):
            factor = part.slope / slope
            if at in lost or (self.moves(part) and not JUMP_RANGE[0] <= factor <= JUMP_RANGE[1]):
                messages.append(_jump(part, factor, at in lost, _usual(self.intervals, part)))
        return messages


def seams(check: MotionCheck) -> list[int]:
    """Numbers of the frames that do not follow from the one before: displacements ignore the velocities."""
    least = LOST_TOUCH * np.sqrt(check.explained())
    if check.slope() is None:
        return []
    return [
        at + 1 for at, part in enumerate(check.intervals) if check.moves(part) and part.correlation < least
    ]


def _interval(
    before: Entry,
    ids: np.ndarray,
    rows: np.ndarray,
    after: Entry,
    next_ids: np.ndarray,
    next_rows: np.ndarray,
    periods_m: tuple[float, float],
) -> Interval:
    if not np.array_equal(ids, next_ids):
        _, here, there = np.intersect1d(ids, next_ids, assume_unique=True, return_indices=True)
        rows, next_rows = rows[:, here], next_rows[:, there]
    moved = next_rows[:2] - rows[:2]
    for axis, period in zip(moved, periods_m, strict=True):
        if period:
            axis -= period * np.round(axis / period)
    expected = (next_rows[2:4] + rows[2:4]) / 2 * (after.time_s - before.time_s)
    product, square, moved_square = (expected * moved).sum(), (expected**2).sum(), (moved**2).sum()
    slope = product / square if square > 0 else np.nan
    correlation = product / np.sqrt(square * moved_square) if square > 0 and moved_square > 0 else np.nan
    distance = float(np.sqrt((moved**2).sum(axis=0)).mean()) if moved.size else 0.0
    return Interval(before, after, float(slope), float(correlation), distance)


def _name(entry: Entry) -> str:
    return Path(entry.file).name + ("" if entry.step is None else f" (step {entry.step})")


def _repeated(part: Interval) -> str:
    before, after = _name(part.before), _name(part.after)
    return f"{after} repeats the positions of {before}: no particle has moved between them"


def _unrelated(explained: float) -> str:
    return (
        f"velocities explain {explained:.0%} of the displacements between frames: the frames are too far "
        "apart for "
        "them, so times and units cannot be checked by them"
    )


def _wrong_scale(slope: float) -> str:
    return (
        f"particles move {slope:.4g} times as far between frames as their velocities say, in all frames "
        "alike: "
        "frames.step_s (or frames.time_unit_s) may be wrong by this factor, or a unit (lengths and "
        "velocities have "
        "frames.length_unit_m in common)"
    )


def _usual(intervals: list[Interval], part: Interval) -> float:
    at = intervals.index(part)
    near = [other.displacement_m for other in intervals[max(0, at - 3) : at + 4] if other is not part]
    return float(np.median(near)) if near else np.nan


def _jump(part: Interval, factor: float, lost: bool, usual_m: float) -> str:
    between = f"from {_name(part.before)} to {_name(part.after)}"
    ratio = part.displacement_m / usual_m if usual_m else np.nan
    if lost:
        return (
            f"{between} particles move {1000 * part.displacement_m:.4g} mm, {ratio:.3g} times as far as in "
            "the intervals "
            f"around, and not as their velocities say (correlation {part.correlation:.2f}): two runs are "
            "mixed here, "
            "or frames are missing; take one of them by frames.first_step and frames.last_step"
        )
    return (
        f"{between} particles move {factor:.3g} times as far as their velocities say, beside the other "
        "intervals: "
        "a frame is missing, repeated or foreign here"
    )
