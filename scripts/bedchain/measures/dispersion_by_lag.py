# SPDX-License-Identifier: GPL-3.0-or-later
"""Dispersion coefficient of particles as a function of the lag: var(displacement) / (2 lag).

It rises while the lag is shorter than the correlation time of the velocity, and falls again once particles
have seen the whole bed.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import DataError

Array = NDArray[np.float64]

# displacements of so many particles from so many origins, evenly spread, give a coefficient within 2 %
MOST_PARTICLES, MOST_ORIGINS = 1000, 100
# lags are tried one by one up to this one, then so many in each doubling: known to 3 %
EACH_LAG_UP_TO = 32
# blocks of the window that are left out in turn
BLOCKS = 5


@dataclass(frozen=True)
class DispersionByLag:
    """Dispersion coefficients along x and z over lags up to half of a window.

    Parameters
    ----------
    lags : (n_lags,) int array
        Rising lags [frames].
    interval_s : float
        Time between two frames [s].
    window_s : float
        Length of the window [s].
    coefficient_m2_s : (n_lags, 2) array
        Of all displacements [m2/s].
    left_out_m2_s : (BLOCKS, n_lags, 2) array
        Of those that start outside one of five equal blocks of the window [m2/s].
    """

    lags: NDArray[np.int64]
    interval_s: float
    window_s: float
    coefficient_m2_s: Array
    left_out_m2_s: Array

    @property
    def lags_s(self) -> Array:
        """The lags as times, (n_lags,) [s]."""
        return np.asarray(self.lags * self.interval_s)


def thinned(place: NDArray[np.floating]) -> Array:
    """Positions of at most `MOST_PARTICLES` particles, evenly spread over their numbers."""
    every = -(-place.shape[1] // MOST_PARTICLES)
    return np.asarray(place[:, ::every], dtype=np.float64)


def dispersion_by_lag(
    x_m: NDArray[np.floating], z_m: NDArray[np.floating], interval_s: float
) -> DispersionByLag:
    """Dispersion coefficients over lags up to half of the frames.

    Parameters
    ----------
    x_m, z_m : (n_frames, n_particles) array
        Positions in evenly spaced frames [m].
    interval_s : float
        Time between two frames [s].

    Returns
    -------
    DispersionByLag

    Raises
    ------
    DataError
        There are fewer than three frames, or no particle.
    """
    n_frames = len(x_m)
    if x_m.shape[1] == 0:
        raise DataError("no particle is in all frames of the learning window: give chain.lag_s and cells")
    if n_frames < 3:
        raise DataError(f"{n_frames} frames hold no dispersion over lags: lengthen the learning window")
    places = np.stack((thinned(x_m), thinned(z_m)))
    lags = lags_up_to((n_frames - 1) // 2)
    by_block = np.stack([_moments(places, int(lag)) for lag in lags])
    twice_s = 2.0 * lags * interval_s
    whole = _variance(by_block.sum(axis=1)) / twice_s[:, None]
    parts = [
        _variance(by_block.sum(axis=1) - by_block[:, block]) / twice_s[:, None] for block in range(BLOCKS)
    ]
    return DispersionByLag(lags, interval_s, (n_frames - 1) * interval_s, whole, np.stack(parts))


def lags_up_to(longest: int) -> NDArray[np.int64]:
    """Lags to try: each of the first `EACH_LAG_UP_TO`, then as many in each doubling, and the longest."""
    doublings = np.log2(max(longest, EACH_LAG_UP_TO) / EACH_LAG_UP_TO)
    further = EACH_LAG_UP_TO * 2.0 ** (np.arange(int(doublings * EACH_LAG_UP_TO) + 1) / EACH_LAG_UP_TO)
    lags = np.concatenate((np.arange(1, EACH_LAG_UP_TO), further.round(), [longest])).astype(np.int64)
    return np.unique(lags[lags <= longest]).astype(np.int64)


def _moments(places: Array, lag: int) -> Array:
    """Number, sums and sums of squares of the displacements by block of their start, (BLOCKS, 3, 2)."""
    room = places.shape[1] - lag
    origins = np.unique(np.linspace(0, room - 1, min(room, MOST_ORIGINS)).round().astype(int))
    steps = places[:, origins + lag] - places[:, origins]
    number = np.full((2, origins.size), float(places.shape[2]))
    values = (number, steps.sum(axis=2), np.einsum("aop,aop->ao", steps, steps))
    block = origins * BLOCKS // room
    sums = [[np.bincount(block, axis, BLOCKS) for axis in value] for value in values]
    return np.array(sums, np.float64).transpose(2, 0, 1)


def _variance(moments: Array) -> Array:
    """Variance from number, sum and sum of squares, (n_lags, 3, 2); NaN without displacements."""
    number, total, square = moments[:, 0], moments[:, 1], moments[:, 2]
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.maximum(square / number - (total / number) ** 2, 0.0))
