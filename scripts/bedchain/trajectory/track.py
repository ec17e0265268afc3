# SPDX-License-Identifier: GPL-3.0-or-later
"""Tracks of one or a few tracers at uneven times, as frames at even times, such as those of PEPT.

A chain of a bed learned from one tracer takes for granted that the tracer goes wherever particles go, in
shares of time that are the shares of the particles (ergodicity); `visits` says what the track shows of that.
"""

import json
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import DataError
from bedchain.files import atomic_file, write_text
from bedchain.trajectory.grid import OUTSIDE
from bedchain.trajectory.store import open_trajectory

# entries of a cell after which shares of time are known to a third
FEW_ENTRIES = 10
# of an interval: a location so near to a multiple is at it
ROUND_OFF = 1e-9


class Track(NamedTuple):
    """Positions of tracers at even times.

    Attributes
    ----------
    times_s : (n_frames,) array
        Multiples of the interval, from the first location on [s].
    positions_m : (n_axes, n_frames, n_tracers) array
        [m]; NaN where no location is near enough before or after.
    kept, dropped : int
        Frames of a tracer with a position, and without one between its first and its last location [1].
    """

    times_s: NDArray[np.float64]
    positions_m: NDArray[np.float64]
    kept: int
    dropped: int


def even_track(
    times_s: NDArray[np.floating],
    positions_m: NDArray[np.floating],
    tracers: NDArray[np.integer],
    interval_s: float,
    reach_s: float,
) -> Track:
    """Positions on a straight line between the locations before and after each multiple of an interval.

    Parameters
    ----------
    times_s : (n_locations,) array
        Times of the locations, of each tracer rising [s].
    positions_m : (n_axes, n_locations) array
        [m].
    tracers : (n_locations,) int array
        Tracer that was located.
    interval_s : float
        Time between two frames [s]; the lag of a chain is a multiple of it.
    reach_s : float
        Farthest that the location before and the one after may be away [s]; without both the position is
        dropped.

    Returns
    -------
    Track
        Tracers in rising order.

    Raises
    ------
    DataError
        Times are not finite or do not rise, the interval or reach is not positive, or no two
        frames in a row are kept.
    """
    if not (interval_s > 0 and reach_s > 0):
        raise DataError(
            f"an interval of {interval_s:g} s and a reach of {reach_s:g} s: both must be positive"
        )
    times, places = np.asarray(times_s, float), np.asarray(positions_m, float)
    if not (np.isfinite(times).all() and np.isfinite(places).all()):
        location = int(np.flatnonzero(~(np.isfinite(times) & np.isfinite(places).all(axis=0)))[0])
        raise DataError(f"location {location} (counted from 0) of the track is not finite: leave it out")
    frames = np.arange(int((times.max() - times.min()) / interval_s + ROUND_OFF) + 1)
    even = times.min() + interval_s * frames
    slack = ROUND_OFF * interval_s
    names, kept, dropped = np.unique(tracers), 0, 0
    track = np.full((len(places), even.size, names.size), np.nan)
    for column, name in enumerate(names):
        of_tracer = np.flatnonzero(np.asarray(tracers) == name)
        when = times[of_tracer]
        if (np.diff(when) <= 0).any():
            at = int(np.argmax(np.diff(when) <= 0))
            raise DataError(
                f"tracer {name} is located at {when[at + 1]:g} s after {when[at]:g} s: order its locations "
                "by time, each time once"
            )
        after = np.clip(np.searchsorted(when, even), 1, max(when.size - 1, 1)) if when.size > 1 else None
        if after is None:
            continue
        ahead, behind = when[after] - even, even - when[after - 1]
        within = np.minimum(ahead, behind) >= -slack
        at_hand = (ahead <= reach_s) & (behind <= reach_s)
        near = within & (at_hand | (np.minimum(ahead, behind) <= slack))
        for axis, place in enumerate(places):
            line = np.interp(even, when, place[of_tracer])
            track[axis, near, column] = line[near]
        kept, dropped = kept + int(near.sum()), dropped + int((within & ~near).sum())
    seen = np.isfinite(track[0])
    if not (seen[1:] & seen[:-1]).any():
        raise DataError(
            f"no two multiples of {interval_s:g} s in a row have locations within {reach_s:g} s before and "
            f"after: the track has one each {np.median(np.diff(np.sort(times))):g} s; take a longer reach"
        )
    return Track(np.asarray(interval_s * frames, float), track, kept, dropped)


def resample(trajectory: Path, metadata: Path, every_s: float, reach_s: float) -> str:
    """Write a trajectory of tracers at uneven times anew, at multiples of a time; velocities are left out.

    Parameters
    ----------
    trajectory, metadata : Path
        ``trajectory.npy`` and ``trajectory.json``; replaced.
    every_s, reach_s : float
        As `even_track` [s].

    Returns
    -------
    str
        How many positions were kept and dropped.
    """
    values, about = open_trajectory(trajectory, metadata)
    places = [row for row, name in enumerate(about["columns"]) if name in ("x", "z", "y")]
    frame, tracer = np.nonzero(np.isfinite(values[:, 0]))
    order = np.lexsort((frame, tracer))
    frame, tracer = frame[order], tracer[order]
    located = np.asarray(values[frame][:, places, :], float)[np.arange(frame.size), :, tracer].T
    track = even_track(np.array(about["times_s"])[frame], located, tracer, every_s, reach_s)
    shape = (len(track.times_s), values.shape[1], track.positions_m.shape[2])
    even = np.full(shape, np.nan, np.float32)
    even[:, places] = np.moveaxis(track.positions_m, 0, 1)
    with atomic_file(trajectory) as temporary, temporary.open("wb") as stream:
        np.save(stream, even)
    new = {"times_s": track.times_s.tolist(), "steps": list(range(shape[0])), "frame_interval_s": every_s}
    write_text(metadata, json.dumps(about | new | {"complete": not track.dropped}))
    share = track.dropped / (track.kept + track.dropped)
    return (
        f"{track.kept} positions at multiples of {every_s:g} s, {track.dropped} ({share:.1%}) dropped, whose "
        f"neighbours are more than {reach_s:g} s away"
    )


def visits(cells: NDArray[np.int32], n_cells: int) -> dict[str, float]:
    """How much of a bed a track has seen, and how often it came back.

    Parameters
    ----------
    cells : (n_frames, n_tracers) int array
        `grid.OUTSIDE` where the position was dropped.
    n_cells : int

    Returns
    -------
    dict
        ``cells_seen_1``: cells that a tracer was in; ``entries_1``: mean number of times that each of them
        was entered, weighted by the time spent there.
    """
    seen = cells != OUTSIDE
    spent = np.bincount(cells[seen], minlength=n_cells)
    entered = (cells[1:] != cells[:-1]) & seen[1:] & seen[:-1]
    entries = np.bincount(cells[1:][entered], minlength=n_cells)
    return {
        "cells_seen_1": float((spent > 0).sum()),
        "entries_1": float(entries @ spent / max(spent.sum(), 1)),
    }


def ergodicity_warning(cells: NDArray[np.int32], n_cells: int, number: int) -> str:
    """Warning that a chain of so many tracers stands for a whole bed; stronger where they came back seldom.

    Parameters
    ----------
    cells : (n_frames, n_tracers) int array
    n_cells : int
    number : int
        Tracers.
    """
    seen = visits(cells, n_cells)
    tracers = "one tracer" if number == 1 else f"{number} tracers"
    words = (
        f"a chain of {tracers} takes for granted that shares of time are shares of particles (ergodicity): "
        f"{seen['cells_seen_1']:.0f} of {n_cells} cells were seen"
    )
    if seen["entries_1"] < FEW_ENTRIES:
        return f"{words}, a cell {seen['entries_1']:.1f} times only: the track is too short for that"
    return f"{words}, a cell {seen['entries_1']:.0f} times"
