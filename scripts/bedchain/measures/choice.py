# SPDX-License-Identifier: GPL-3.0-or-later
"""The lag and the cells of a chain by rule, from the particles' dispersion in the learning window alone.

The lag is the first one at which var(displacement) / (2 lag) has 95 % of its maximum on every axis: by then
the velocity is forgotten, and a longer lag would only be coarser. Where walls end the rise sooner, the lag is
raised until the memory that the place does not explain (`remaining_memory`) is below 5 %. The cells are the
largest whose added dispersion, h^2 E[f (1 - f)] / (2 lag) (`numerical_dispersion`), is below 5 % of the
particles' on every axis.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bedchain.case.presets import FEWEST_CELLS, LEVEL_DIAMETERS
from bedchain.errors import DataError
from bedchain.measures.dispersion_by_lag import DispersionByLag, thinned
from bedchain.measures.numerical_dispersion import added_share
from bedchain.measures.remaining_memory import remaining_memory
from bedchain.physics.whole_numbers import ratio

Array = NDArray[np.float64]
AXES = ("x", "z")

REACHED = 0.95  # of the maximum: near its top the dispersion is flat and the place of the maximum uncertain
MOST_MEMORY = 0.05  # correlation of successive displacements that the place does not explain
MOST_ADDED = 0.05  # of the particles' dispersion, by the cells
FEWEST_PARTICLES = 10  # of fewer a variance is known to no digit
FEWEST_CORRELATIONS = 3  # correlation times in a window: of fewer no maximum can be told from a fluctuation
LONGEST = 0.2  # of the window: the lag where the dispersion has no maximum, and the longest it is raised to
MOST_ELONGATED = 1.25  # longer over shorter side of a cell
GIVE = "give chain.lag_s and cells, or a longer learning window"


@dataclass(frozen=True)
class ChosenLag:
    """A lag by rule.

    Parameters
    ----------
    frames : int
        The lag [frames].
    on_axis : (2,) int array
        The same of each axis alone; 0 of an axis without motion.
    maximum : (2,) int array
        Lag of the largest dispersion on each axis [frames].
    range : (int, int)
        Least and largest lag when a fifth of the window is left out in turn [frames].
    doubts : tuple of str
        Reasons why the lag cannot be trusted; empty where it can.
    remark : str
        Where the lag is bounded by the frames, or was raised; else empty.
    memory : (2,) array
        Correlation of successive displacements that the place does not explain, by axis [1].
    """

    frames: int
    on_axis: NDArray[np.int64]
    maximum: NDArray[np.int64]
    range: tuple[int, int]
    doubts: tuple[str, ...] = ()
    remark: str = ""
    memory: tuple[float, float] = (math.nan, math.nan)


@dataclass(frozen=True)
class ChosenCells:
    """Cells by rule.

    Parameters
    ----------
    columns, rows : int
    added : (2,) array
        Their added dispersion over the particles', along x and z [1].
    tried : list of (cell_m, x share, z share)
        All cells that were looked at.
    doubt : str
        Why they cannot be trusted; empty where they can.
    """

    columns: int
    rows: int
    added: Array
    tried: list[tuple[float, float, float]]
    doubt: str = ""


def choose_lag(curve: DispersionByLag, particles: int, diameter_m: float) -> ChosenLag:
    """The lag by rule.

    Parameters
    ----------
    curve : DispersionByLag
        Of the learning window.
    particles : int
        In the bed [1].
    diameter_m : float
        Of a particle [m].

    Returns
    -------
    ChosenLag

    Raises
    ------
    DataError
        There are fewer than `FEWEST_PARTICLES`, or they move less than their diameter in half the window.
    """
    if particles < FEWEST_PARTICLES:
        raise DataError(
            f"the dispersion of {particles} particle{'s' * (particles > 1)} is known to no digit, at least "
            f"{FEWEST_PARTICLES} are needed for a lag and cells by rule: give chain.lag_s and cells"
        )
    moved_m = np.sqrt(2 * curve.coefficient_m2_s * curve.lags_s[:, None]).max(axis=0)
    moving = np.flatnonzero(moved_m >= diameter_m)
    if moving.size == 0:
        raise DataError(
            f"the particles are at rest: they spread by {moved_m.max():.3g} m in {curve.lags_s[-1]:g} s, "
            f"less than their diameter, {diameter_m:g} m: {GIVE}"
        )
    places, tops = _reached(curve.coefficient_m2_s, moving)
    without = [max(_reached(part, moving)[0][moving]) for part in curve.left_out_m2_s]
    place = max(places[moving])
    chosen = ChosenLag(
        int(curve.lags[place]), _lags(curve, places, moving), _lags(curve, tops, moving),
        (int(curve.lags[min(without)]), int(curve.lags[max(without)])),
    )  # fmt: skip
    return _judged(chosen, curve, moving)


def _judged(chosen: ChosenLag, curve: DispersionByLag, moving: NDArray[np.intp]) -> ChosenLag:
    """The lag with its doubts: a maximum at the end of the window is none, unless it ends a plateau."""
    longest, interval_s = int(curve.lags[-1]), curve.interval_s
    at_end = [AXES[axis] for axis in moving if chosen.maximum[axis] >= REACHED * longest]
    if at_end and chosen.frames > longest / 2:
        frames = max(1, int(LONGEST * curve.window_s / interval_s))
        doubt = (
            f"along {' and '.join(at_end)} the dispersion still rises at {longest * interval_s:g} s, half of "
            f"the window: it has no maximum, and the lag is a fifth of the window instead; {GIVE}"
        )
        return replace(chosen, frames=frames, doubts=(doubt,))
    doubts = []
    times = curve.window_s / (interval_s * max(chosen.maximum[moving]))
    if times < FEWEST_CORRELATIONS and not at_end:
        doubts.append(
            f"the window is {times:.2g} times as long as the lag of the largest dispersion, less than "
            f"{FEWEST_CORRELATIONS}: its maximum may be a fluctuation; {GIVE}"
        )
    remark = ""
    if chosen.frames == 1:
        remark = (
            "the frames are coarser than the correlation time: their interval is the shortest lag there is"
        )
    elif at_end:
        remark = f"along {' and '.join(at_end)} a plateau up to the end of the window for a maximum"
    return replace(chosen, doubts=tuple(doubts), remark=remark)


def raised(chosen: ChosenLag, curve: DispersionByLag, places_m: Array) -> ChosenLag:
    """The lag, raised until the place explains all but `MOST_MEMORY` of the memory.

    Parameters
    ----------
    chosen : ChosenLag
        Of `choose_lag`; one with doubts is only given its memory.
    curve : DispersionByLag
        Of the same window.
    places_m : (2, n_frames, n_particles) array
        Its positions [m].

    Returns
    -------
    ChosenLag
        With the memory at its lag. Where none up to a fifth of the window has so little memory: the one with
        the least, and a remark.
    """
    longest = max(chosen.frames, int(LONGEST * curve.window_s / curve.interval_s))
    lags = [int(lag) for lag in curve.lags if chosen.frames <= lag <= longest] or [chosen.frames]
    memories: list[Array] = []
    for lag in lags if not chosen.doubts else lags[:1]:
        memories.append(remaining_memory(places_m, lag))
        if memories[-1].max() <= MOST_MEMORY:
            break
    place = (
        len(memories) - 1
        if memories[-1].max() <= MOST_MEMORY
        else int(np.argmin([m.max() for m in memories]))
    )
    memory = (float(memories[place][0]), float(memories[place][1]))
    if place == 0 and max(memory) <= MOST_MEMORY:
        return replace(chosen, memory=memory)
    remark = (
        f"raised from {chosen.frames * curve.interval_s:g} s, where walls end the rise of the dispersion "
        f"before the motion is forgotten; {max(0.0, *memory):.0%} of memory remain"
    )
    return replace(chosen, frames=lags[place], memory=memory, remark=remark)


def correlation_times(curve: DispersionByLag) -> Array:
    """Correlation time of the velocity, largest dispersion over the variance of the velocity, (2,) [s].

    The velocity is that between two frames: where it is forgotten sooner, this is half the frame interval.
    """
    first = curve.coefficient_m2_s[0]
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(curve.coefficient_m2_s.max(axis=0) * curve.lags_s[0] / (2 * first))


def _reached(coefficient: Array, moving: NDArray[np.intp]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Places of the first `REACHED` share of the maximum and of the maximum itself, by axis."""
    known = np.nan_to_num(coefficient)
    tops = known.argmax(axis=0)
    places = (known >= REACHED * known.max(axis=0)).argmax(axis=0)
    return _only(places, moving), _only(tops, moving)


def _only(places: NDArray[np.intp], moving: NDArray[np.intp]) -> NDArray[np.intp]:
    kept = np.zeros_like(places)
    kept[moving] = places[moving]
    return kept


def _lags(curve: DispersionByLag, places: NDArray[np.intp], moving: NDArray[np.intp]) -> NDArray[np.int64]:
    lags = np.zeros(2, np.int64)
    lags[moving] = curve.lags[places[moving]]
    return lags


def choose_cells(
    places_m: tuple[NDArray[np.floating], NDArray[np.floating]], size_m: tuple[float, float],
    lines_m: Sequence[float], diameter_m: float, lag: int,
) -> ChosenCells:  # fmt: skip
    """The largest nearly square cells whose added dispersion is below `MOST_ADDED` on every axis.

    Parameters
    ----------
    places_m : two (n_frames, n_particles) arrays
        Positions along x and z [m].
    size_m : (float, float)
        Width and height of the bed [m].
    lines_m : (float, float)
        Lines between the marked groups [m]; no cell is higher than what is below the second.
    diameter_m : float
        Of a particle: no cell is smaller; sides are whole halves of it where those divide the bed [m].
    lag : int
        [frames].

    Returns
    -------
    ChosenCells
        The smallest cells there are, with a doubt, where none adds so little.
    """
    fine = [thinned(place) for place in places_m]
    counts = [counts_of(*side, diameter_m) for side in zip(size_m, lines_m, strict=True)]
    tried = []
    shapes = sorted(_shapes(counts, size_m))
    for side, *shape in shapes:
        sizes = [length_m / count for length_m, count in zip(size_m, shape, strict=True)]
        x, z = (added_share(place, size, lag) for place, size in zip(fine, sizes, strict=True))
        tried.append((side, x, z))
    fit = [number for number, (_, *shares) in enumerate(tried) if max(shares) < MOST_ADDED]
    side, columns, rows = shapes[fit[-1] if fit else 0]
    added = np.array(tried[fit[-1] if fit else 0][1:])
    doubt = ""
    if not fit:
        doubt = (
            f"even the smallest cells, {side:.3g} m, add {added.max():.0%} to the particles' dispersion, "
            f"more than {MOST_ADDED:.0%}: the lag is too short for cells that hold particles; {GIVE}"
        )
    return ChosenCells(columns, rows, added, tried, doubt)


def counts_of(length_m: float, line_m: float, diameter_m: float) -> list[int]:
    """Numbers of cells along a side of the bed that may be chosen, rising; at least one.

    Parameters
    ----------
    length_m, line_m, diameter_m : float
        Of the side, of the line between two groups on it, and of a particle [m].
    """
    levels = ratio(length_m, LEVEL_DIAMETERS * diameter_m)
    most = max(1, int(ratio(length_m, diameter_m)))
    least = min(most, max(FEWEST_CELLS, math.ceil(ratio(length_m, line_m))))
    counts = range(least, most + 1)
    whole = [count for count in counts if levels.denominator == 1 and levels % count == 0]
    return whole or list(counts)


def _shapes(counts: list[list[int]], size_m: tuple[float, float]) -> list[tuple[float, int, int]]:
    """Side of a square as large as the cell [m], columns and rows, of each number of columns.

    Of all rows those whose cells are the most nearly square; left out where they are too long.
    """
    (width_m, height_m), rows_known = size_m, np.array(counts[1])
    elongation = {}
    for columns in counts[0]:
        ratios = np.abs(np.log(height_m / rows_known * columns / width_m))
        rows = int(rows_known[ratios.argmin()])
        side = math.sqrt(width_m / columns * height_m / rows)
        elongation[side, columns, rows] = float(ratios.min())
    square = [shape for shape, off in elongation.items() if off <= math.log(MOST_ELONGATED)]
    return square or [min(elongation, key=lambda shape: elongation[shape])]
