# SPDX-License-Identifier: GPL-3.0-or-later
"""The noise floor: the spread of realisations of one bed, against which chains are judged."""

import numpy as np
from numpy.typing import NDArray
from scipy import special

from bedchain.uncertainty.deviations import deviations, rms

LEVEL = 0.95
# of sums of shares; realisations closer than this are the same
ROUND_OFF = 1e-12


def floor_of(curves: NDArray[np.float64]) -> float:
    """Noise floor of some columns of curves: the rms of their `deviations`.

    It is the rms error of the bed's exact mean against a single realisation, and the rms difference between
    two realisations over sqrt(2).

    Parameters
    ----------
    curves : (n_realisations, n_times, n_columns) ndarray
        At least two realisations, from the first frame after the start [1]. At the start all curves are 1
        by definition: no floor and no error counts it.
    """
    return float(rms(deviations(curves, np.zeros(len(curves), np.int64))))


def noise_floor(curves: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """`floor_of` each column, with its 95 % interval.

    The interval is that of a variance of n_realisations - 1 degrees of freedom (chi square), as if the times
    of a curve were fully correlated: it is rather too wide than too narrow.

    Parameters
    ----------
    curves : (n_realisations, n_times, n_columns) ndarray
        From the first frame after the start [1].

    Returns
    -------
    floor : (n_columns,) ndarray
        [1]
    interval : (2, n_columns) ndarray
        [1]
    """
    floor = np.array([floor_of(curves[..., [column]]) for column in range(curves.shape[-1])])
    degrees = len(curves) - 1
    ends = 2 * special.gammaincinv(degrees / 2, [(1 + LEVEL) / 2, (1 - LEVEL) / 2])
    return floor, np.sqrt(degrees / ends)[:, None] * floor
