# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of curves from several starts and runs, and deviations of the DEM's curves, with intervals.

Curves of different starts end at different times: arrays are padded with NaN, which no function counts.
"""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from bedchain.measures.batch import total_variation

Array = NDArray[np.float64]

# columns of the curves (in the order of `mixing.GROUPS`) that make up each summary
SIDES = {
    "left": (0,),
    "right": (1,),
    "low": (2,),
    "up": (3,),
    "radial": (0, 1),
    "axial": (2, 3),
    "mixing": (0, 1, 2, 3),
}


def stacked(curves: Sequence[Array]) -> Array:
    """Curves of unequal length as one array, (n_curves, n_times, ...), NaN where a curve has ended."""
    length = max(len(curve) for curve in curves)
    table = np.full((len(curves), length, *curves[0].shape[1:]), np.nan)
    for row, curve in zip(table, curves, strict=True):
        row[: len(curve)] = curve
    return table


def resampled(run: NDArray[np.integer], replicates: int, rng: np.random.Generator) -> Array:
    """Number of times that each curve counts in each replicate: runs are drawn, then curves of each run.

    Parameters
    ----------
    run : (n_curves,) int array
        Run of each curve; with a single run only its curves are drawn.
    replicates : int
    rng : numpy Generator

    Returns
    -------
    (replicates, n_curves) array
        A replicate sums to ``n_curves`` if all runs have as many curves.
    """
    members = [np.flatnonzero(run == number) for number in np.unique(run)]
    weights = np.zeros((replicates, run.size))
    for row in weights:
        for drawn in rng.integers(0, len(members), len(members)):
            curves = members[drawn]
            again = curves[rng.integers(0, curves.size, curves.size)]
            row += np.bincount(again, minlength=run.size)
    return weights


def band(samples: Array, level: float = 0.95) -> tuple[Array, Array]:
    """Ends of the central interval of replicates over the first axis (percentile band).

    Parameters
    ----------
    samples : (n_replicates, ...) array
        Of starts and runs that were drawn with `resampled`.
    level : float
        Share of the replicates inside [1].

    Returns
    -------
    low, high : (...) array
    """
    low, high = np.quantile(samples, [(1 - level) / 2, (1 + level) / 2], axis=0)
    return low, high


def signed(error: Array, weights: Array | None = None) -> Array:
    """Mean over curves, times and columns; (n_replicates,) with weights, else a scalar.

    Parameters
    ----------
    error : (n_curves, n_times, n_columns) array
        Model - DEM [1].
    weights : (n_replicates, n_curves) array, optional
        From `resampled`.
    """
    return _weighted(np.nansum(error, axis=(1, 2)), _counted(error), weights)


def rms(error: Array, weights: Array | None = None) -> Array:
    """Root of the mean square over curves, times and columns; arguments as `signed`."""
    return np.sqrt(_weighted(np.nansum(error**2, axis=(1, 2)), _counted(error), weights))


def mean_size(error: Array, weights: Array | None = None) -> Array:
    """Root mean square over the curves of their means over times and columns; arguments as `signed`."""
    counted = _counted(error)
    means = np.divide(np.nansum(error, axis=(1, 2)), counted, out=np.zeros(len(error)), where=counted > 0)
    return np.sqrt(_weighted(means**2, (counted > 0).astype(float), weights))


def interval(
    summary: Callable[[Array, Array | None], Array], error: Array, weights: Array
) -> tuple[float, float]:
    """95 % interval of a summary over starts and runs; NaN with fewer than two curves of finite values.

    Parameters
    ----------
    summary : callable
        `signed`, `rms` or `mean_size`.
    error : (n_curves, n_times, n_columns) array
    weights : (n_replicates, n_curves) array
        From `resampled`.

    Returns
    -------
    low, high : float
    """
    if (_counted(error) > 0).sum() < 2:
        return float("nan"), float("nan")
    samples = summary(error, weights)
    low, high = band(samples[np.isfinite(samples)])
    return float(low), float(high)


def deviations(observed: Array, group: NDArray[np.integer]) -> Array:
    """Deviation of each curve of the DEM from the mean of its group, scaled so that its square is unbiased.

    With repeated runs a group is the curves that start at the same time, without them all curves. The rms of
    the deviations is the noise floor: the rms error of the exact mean of all possible runs. The error of
    another single run is sqrt(2) times as large.

    Parameters
    ----------
    observed : (n_curves, n_times, n_columns) array
        Curves of the DEM [1].
    group : (n_curves,) int array
        Group of each curve.

    Returns
    -------
    array of the same shape
        NaN at times with fewer than two curves of the group.
    """
    scaled = np.full(observed.shape, np.nan)
    for label in np.unique(group):
        members = group == label
        curves = observed[members]
        number = np.isfinite(curves).sum(axis=0)
        mean = np.divide(
            np.nansum(curves, axis=0), number, out=np.full(number.shape, np.nan), where=number > 1
        )
        scaled[members] = (curves - mean) * np.sqrt(number / np.maximum(number - 1, 1))
    return scaled


def distances(first: Array, second: Array) -> Array:
    """Total variation of pairs of densities, NaN where a density is missing.

    Parameters
    ----------
    first, second : (n_curves, n_moments, n_cells) array
        Shares [1].

    Returns
    -------
    (n_curves, n_moments, 1) array
        0 to 1 [1].
    """
    distance = np.full((*first.shape[:2], 1), np.nan)
    for place in np.ndindex(*first.shape[:2]):
        if np.isfinite(first[place]).all() and np.isfinite(second[place]).all():
            distance[place] = total_variation(first[place], second[place])
    return distance


def mean_of_others(densities: Array, group: NDArray[np.integer]) -> Array:
    """Mean density of the other members of each curve's group, NaN without any.

    Parameters
    ----------
    densities : (n_curves, n_moments, n_cells) array
        Shares [1].
    group : (n_curves,) int array

    Returns
    -------
    array of the same shape
    """
    means = np.full(densities.shape, np.nan)
    for curve in range(len(densities)):
        others = densities[(group == group[curve]) & (np.arange(len(densities)) != curve)]
        number = np.isfinite(others).sum(axis=0)
        means[curve] = np.divide(
            np.nansum(others, axis=0), number, out=np.full(number.shape, np.nan), where=number > 0
        )
    return means


def fluctuation(curves: Array, half_width: int) -> Array:
    """Curves minus their running means: the fluctuations by bubbles, without the mean decay.

    Parameters
    ----------
    curves : (n_curves, n_times, n_columns) array
    half_width : int
        Times on each side of the running mean [1].

    Returns
    -------
    (n_curves, n_times - 2 half_width, n_columns) array
        Its `rms` is the size of the fluctuations; no times if the curves are too short.
    """
    width = 2 * half_width + 1
    if curves.shape[1] < width:
        return curves[:, :0]
    windows = np.lib.stride_tricks.sliding_window_view(curves, width, axis=1)
    return np.asarray(curves[:, half_width : curves.shape[1] - half_width] - windows.mean(axis=-1))


def _counted(error: Array) -> Array:
    return np.isfinite(error).sum(axis=(1, 2)).astype(float)


def _weighted(total: Array, number: Array, weights: Array | None) -> Array:
    if weights is None:
        return np.asarray(total.sum() / number.sum() if number.sum() > 0 else np.nan)
    counted = weights @ number
    return np.divide(weights @ total, counted, out=np.full(len(weights), np.nan), where=counted > 0)
