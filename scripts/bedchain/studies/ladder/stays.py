# SPDX-License-Identifier: GPL-3.0-or-later
"""Residence in the lower part of a closed bed: how long its particles take to rise out of it.

A closed bed has no residence time of its own. Here it is the restricted mean: particles that start below
the line of the mixing count until they are first `OUT` lines high, or until the horizon. A particle that
swings about one line would leave and come back at every frame: the mean would depend on their interval.
"""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

OUT = 1.5  # times the line: out of the lower part


def stay_starts(learning: slice, comparison: slice) -> tuple[list[int], int]:
    """Frames that stays start at, one after the other up to the end of the comparison, and their horizon.

    Returns
    -------
    list of int
        The last two are in the comparison window; those before them, from the learning window on, are for the
        spread.
    int
        Frames until the horizon: half of the comparison window.
    """
    horizon = (comparison.stop - 1 - comparison.start) // 2
    last = comparison.start + horizon
    return list(range(last, learning.start - 1, -horizon))[::-1], horizon


def stay_in_lower_part(
    heights_m: Iterable[NDArray[np.floating]], interval_s: float, line_m: float, horizon_s: float
) -> float:
    """Restricted mean time that particles from below a line take to be `OUT` lines high.

    Parameters
    ----------
    heights_m : iterable of (n_particles,) array
        Heights at even intervals, until the horizon or beyond [m].
    interval_s, line_m, horizon_s : float
        [s], [m], [s].

    Returns
    -------
    float
        At most the horizon [s]; NaN where no particle starts below the line.
    """
    shares: list[float] = []
    for at, heights in enumerate(heights_m):
        if at == 0:
            low = np.flatnonzero(heights < line_m)
            if low.size == 0:
                return float("nan")
            inside = np.ones(low.size, bool)
        inside &= heights[low] < OUT * line_m
        shares.append(float(inside.mean()))
    times = interval_s * np.arange(len(shares))
    until = np.append(times[times < horizon_s], horizon_s)
    return float(np.trapezoid(np.interp(until, times, shares), until))
