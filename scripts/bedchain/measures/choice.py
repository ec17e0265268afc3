# SPDX-License-Identifier: GPL-3.0-or-later
"""The lag of a chain by rule, from the particles' dispersion in the learning window alone.

The lag is the first one at which var(displacement) / (2 lag) has 95 % of its maximum on every axis: by then
the velocity is forgotten, and a longer lag would only be coarser. Where walls end the rise sooner, the lag is
raised until the memory that the place does not explain (`remaining_memory`) is below 2.6 %, which is what a
motion without walls has left at its 95 %. The cells follow from it (`choice_of_cells`).
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import DataError
from bedchain.measures.dispersion_by_lag import DispersionByLag
from bedchain.measures.remaining_memory import remaining_memory

Array = NDArray[np.float64]
AXES = ("x", "z")

REACHED = 0.95  # of the maximum: near its top the dispersion is flat and the place of the maximum uncertain
# Correlation of successive displacements that the place does not explain: that of a motion without walls at
# the lag where its dispersion has `REACHED` of its limit. A velocity that is forgotten within a lag L gives
# displacements of the variance 2 D (L - c), where c = (1 - REACHED) L, and the covariance D c to two
# successive ones.
MOST_MEMORY = (1 - REACHED) / (2 * REACHED)
FEWEST_PARTICLES = 10  # of fewer a variance is known to no digit
FEWEST_CORRELATIONS = 3  # correlation times in a window: of fewer no maximum can be told from a fluctuation
WITHOUT_MAXIMUM = 0.2  # of the window: the lag where the dispersion has no maximum
LONGEST = 1 / 3  # of the window: the longest lag that another is raised to
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
        frames = max(1, int(WITHOUT_MAXIMUM * curve.window_s / interval_s))
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
        With the memory at its lag. Where none up to `LONGEST` of the window has so little memory: the one
        with the least, and a remark.
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
        f"before the motion is forgotten; {max(0.0, *memory):.1%} of memory remain"
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
