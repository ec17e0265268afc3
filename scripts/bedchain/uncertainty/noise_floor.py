# SPDX-License-Identifier: GPL-3.0-or-later
"""How much realisations of one bed differ: the noise floor that chains are judged against."""

import numpy as np
from numpy.typing import NDArray
from scipy import stats

LEVEL = 0.95
# of sums of shares; realisations closer than this are one and the same
ROUND_OFF = 1e-12


def spread(curves: NDArray[np.float64]) -> NDArray[np.float64]:
    """Standard deviation over realisations at each time.

    Parameters
    ----------
    curves : (n_realisations, n_times, 4) ndarray
        Share of each group on its side, by realisation; two at least [1].

    Returns
    -------
    (n_times, 4) ndarray
        With n_realisations - 1 in the denominator [1].
    """
    return np.asarray(curves.std(axis=0, ddof=1))


def noise_floor(curves: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Root mean square over time of the `spread`, with its 95 % interval.

    It is the rms error that the bed's exact mean would still have against a single realisation, and the rms
    difference between two realisations over sqrt(2). The interval is that of a variance of
    n_realisations - 1 degrees of freedom (chi square): one for each further curve, since the times of
    a curve go up and down together; it is rather too wide than too narrow.

    Parameters
    ----------
    curves : (n_realisations, n_times, 4) ndarray

    Returns
    -------
    floor : (4,) ndarray
        [1]
    interval : (2, 4) ndarray
        [1]
    """
    floor = np.sqrt((spread(curves) ** 2).mean(axis=0))
    degrees = len(curves) - 1
    ends = stats.chi2.ppf([(1 + LEVEL) / 2, (1 - LEVEL) / 2], degrees)
    return floor, np.sqrt(degrees / ends)[:, None] * floor
