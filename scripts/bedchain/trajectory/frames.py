# SPDX-License-Identifier: GPL-3.0-or-later
"""Consecutive frames of the same particles, from which chains are learned and started; windows and lags."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import DataError

# Deviation from an even spacing, as a share of the frame interval: times are step numbers times dt, printed
# with few digits.
TIME_TOLERANCE = 1e-3


@dataclass(frozen=True)
class Frames:
    """Consecutive frames; a particle has the same index in all of them.

    Parameters
    ----------
    times_s : (n_frames,) array
        Evenly spaced times [s].
    x_m, z_m : (n_frames, n_particles) array
        Positions [m]; may be memory maps.
    cells : (n_frames, n_particles) int32 array
        Cell of each particle on a grid.
    vx_m_s, vz_m_s : (n_frames, n_particles) array, optional
        Velocities [m/s], where models use them.
    y_m : (n_frames, n_particles) array, optional
        Positions along the depth [m], where they are known.
    """

    times_s: NDArray[np.float64]
    x_m: NDArray[np.floating]
    z_m: NDArray[np.floating]
    cells: NDArray[np.int32]
    vx_m_s: NDArray[np.floating] | None = None
    vz_m_s: NDArray[np.floating] | None = None
    y_m: NDArray[np.floating] | None = None

    def __post_init__(self) -> None:
        check_times(self.times_s)
        shape = (len(self.times_s), self.cells.shape[-1])
        for name in ("x_m", "z_m", "cells", "vx_m_s", "vz_m_s", "y_m"):
            array = getattr(self, name)
            if array is not None and array.shape != shape:
                raise DataError(
                    f"{name} has the shape {array.shape}, {shape} (frames, particles) expected: "
                    "every frame must hold the same particles in the same order"
                )

    @property
    def interval_s(self) -> float:
        """Time between two frames [s]."""
        return float(self.times_s[-1] - self.times_s[0]) / max(len(self.times_s) - 1, 1)

    def seen_last(self) -> "Frames":
        """The same frames of the particles that are in the last one."""
        seen = np.asarray(self.cells[-1]) >= 0
        if seen.all():
            return self
        names = ("x_m", "z_m", "cells", "vx_m_s", "vz_m_s", "y_m")
        arrays = ((name, getattr(self, name)) for name in names)
        return replace(self, **{name: array[:, seen] for name, array in arrays if array is not None})

    def part(self, which: slice) -> "Frames":
        """The frames of a slice, as views."""
        return Frames(
            self.times_s[which],
            self.x_m[which],
            self.z_m[which],
            self.cells[which],
            None if self.vx_m_s is None else self.vx_m_s[which],
            None if self.vz_m_s is None else self.vz_m_s[which],
            None if self.y_m is None else self.y_m[which],
        )


class Window(NamedTuple):
    """A stretch of time, both ends included.

    Attributes
    ----------
    start_s, end_s : float
        Ends [s]; each must be the time of a frame.
    """

    start_s: float
    end_s: float

    def frames(self, times_s: NDArray[np.float64]) -> slice:
        """The frames in it; see `window`."""
        return window(times_s, self.start_s, self.end_s)


def check_times(times_s: NDArray[np.float64]) -> None:
    """Refuse frames that are missing, doubled or out of order.

    Raises
    ------
    DataError
        Two frames are not one interval apart; the first pair is named.
    """
    times = np.asarray(times_s, dtype=np.float64)
    if times.size == 0:
        raise DataError("no frames: the window is empty; check its start and end against the simulated time")
    if times.size < 3:
        if times.size == 2 and times[1] <= times[0]:
            raise DataError(f"frames 0 and 1 are out of order: {times[0]:g} s and {times[1]:g} s")
        return
    gaps = np.diff(times)
    interval = float(np.median(gaps))
    for frame in np.flatnonzero(~(np.abs(gaps - interval) <= TIME_TOLERANCE * abs(interval)) | (gaps <= 0))[
        :1
    ]:
        gap = gaps[frame]
        fault = "out of order or doubled" if not gap > 0 else "missing" if gap > interval else "too close"
        raise DataError(
            f"frames {fault}: frame {frame} is at {times[frame]:g} s and frame {frame + 1} at "
            f"{times[frame + 1]:g} s, {interval:g} s apart expected; write the frames again"
        )


def window(times_s: NDArray[np.float64], start_s: float, end_s: float) -> slice:
    """Slice of the frames from start to end, both included.

    Parameters
    ----------
    times_s : (n_frames,) array
        Evenly spaced times [s].
    start_s, end_s : float
        Ends of the window [s]; each must be the time of a frame.

    Returns
    -------
    slice
        At least two frames.

    Raises
    ------
    DataError
        The window is empty, or an end is not the time of a frame.
    """
    times = np.asarray(times_s, dtype=np.float64)
    check_times(times)
    if not end_s > start_s:
        raise DataError(
            f"the window from {start_s:g} s to {end_s:g} s is empty: its end must be after its start"
        )
    interval = float(times[-1] - times[0]) / max(times.size - 1, 1)
    ends = []
    for name, wanted in (("start", start_s), ("end", end_s)):
        frame = int(np.argmin(np.abs(times - wanted)))
        if abs(times[frame] - wanted) > max(0.01 * interval, 1e-9):
            raise DataError(
                f"the window's {name}, {wanted:g} s, is not the time of a frame (they go from {times[0]:g} s "
                f"to {times[-1]:g} s, {interval:g} s apart): choose a multiple of the frame interval in there"
            )
        ends.append(frame)
    if ends[0] == ends[1]:
        raise DataError(f"the window from {start_s:g} s to {end_s:g} s holds one frame: two are needed")
    return slice(ends[0], ends[1] + 1)


class Lag(NamedTuple):
    """A lag between two frames.

    Attributes
    ----------
    frames : int
        Frames between them.
    seconds : float
        The same as a time [s].
    """

    frames: int
    seconds: float

    @classmethod
    def of(cls, lag_s: float, interval_s: float) -> "Lag":
        """The lag of a time [s] between frames so far apart [s]; see `lag_frames`."""
        return cls(lag_frames(lag_s, interval_s), lag_s)


def lag_frames(lag_s: float, interval_s: float) -> int:
    """Lag as a number of frames.

    Raises
    ------
    DataError
        The lag is not a multiple of the frame interval.
    """
    frames = round(lag_s / interval_s)
    if frames < 1 or abs(lag_s / interval_s - frames) > TIME_TOLERANCE * frames:
        raise DataError(
            f"a lag of {lag_s:g} s is not a multiple of the frame interval, {interval_s:g} s: "
            f"take {max(frames, 1) * interval_s:g} s"
        )
    return frames


def whole_steps(n_frames: int, lag: int) -> int:
    """Steps of a lag that fill a window exactly.

    Parameters
    ----------
    n_frames : int
        Frames in the window, both ends included [1].
    lag : int
        Lag in frames [1].

    Returns
    -------
    int
        ``(n_frames - 1) / lag``.

    Raises
    ------
    DataError
        The window is shorter than the lag, or the lag does not divide it.
    """
    if lag < 1:
        raise DataError(f"a lag of {lag} frames: at least one is needed")
    if n_frames <= lag:
        raise DataError(
            f"a window of {n_frames} frames holds no step of {lag} frames: widen it or cut the lag"
        )
    if (n_frames - 1) % lag:
        raise DataError(
            f"a lag of {lag} frames does not divide the window of {n_frames - 1} frame intervals: end it "
            f"{(n_frames - 1) % lag} intervals earlier or change the lag"
        )
    return (n_frames - 1) // lag
