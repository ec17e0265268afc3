# SPDX-License-Identifier: GPL-3.0-or-later
"""Bands from five equal blocks of time that are left out in turn."""

import numpy as np
from numpy.typing import NDArray
from scipy import stats

LEVEL = 0.95


def left_out_band(
    estimate: NDArray[np.float64], left_out: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """95 % band of an estimate by the jackknife over blocks.

    Parameters
    ----------
    estimate : (...) array
        From the whole window.
    left_out : (n_blocks, ...) array
        The same without each block in turn.

    Returns
    -------
    low, high : (...) array
        ``estimate -+ t se``, se^2 = (n - 1) / n sum (theta_i - mean)^2, t the quantile of n - 1 degrees of
        freedom (2.776 for five blocks).
    """
    blocks = len(left_out)
    spread = ((left_out - left_out.mean(axis=0)) ** 2).sum(axis=0)
    half = stats.t.ppf((1 + LEVEL) / 2, blocks - 1) * np.sqrt((blocks - 1) / blocks * spread)
    return estimate - half, estimate + half
