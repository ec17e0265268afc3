# SPDX-License-Identifier: GPL-3.0-or-later
"""How much realisations of one bed differ: the noise floor that chains are judged against."""

from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import stats

from bedchain.comparison import Metric, metric
from bedchain.errors import UserError
from bedchain.mixing import GROUPS

LEVEL = 0.95
# of sums of shares; realisations closer than this are one and the same
ROUND_OFF = 1e-12


def curves_of(table: pd.DataFrame, source: str, n_times: int) -> NDArray[np.float64]:
    """Curves of one source of mixing.csv.

    Parameters
    ----------
    table : DataFrame
        time_s, source, direction, group, fraction_remaining_1.
    source : str
    n_times : int
        Times that the curves must have.

    Returns
    -------
    (n_times, 4) ndarray
        In the order of `mixing.GROUPS` [1].

    Raises
    ------
    UserError
        The source is missing, or has other times.
    """
    rows = table[table["source"] == source]
    columns = [rows[rows["group"] == group].sort_values("time_s") for _, group in GROUPS]
    if {len(column) for column in columns} != {n_times}:
        raise UserError(
            f"{source}: {len(columns[0])} times, {n_times} expected; delete its mixing.csv and run again"
        )
    return np.column_stack([column["fraction_remaining_1"] for column in columns])


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


def floor_metrics(curves: NDArray[np.float64]) -> list[Metric]:
    """Noise floor of each group, and how many realisations it is from.

    Parameters
    ----------
    curves : (n_realisations, n_times, 4) ndarray

    Returns
    -------
    list of dict
    """
    floor, (low, high) = noise_floor(curves)
    rows: list[dict[str, Any]] = [metric("realisations", "dem", len(curves))]
    for column, (_, group) in enumerate(GROUPS):
        row = metric(f"noise_floor_{group}", "dem", floor[column])
        rows.append(row | {"ci_low": float(low[column]), "ci_high": float(high[column])})
    return rows


def noise_metrics(source: str, model: NDArray[np.float64], curves: NDArray[np.float64]) -> list[Metric]:
    """A chain's error beside the noise: against the DEM's mean, and as a multiple of the noise floor.

    Parameters
    ----------
    source : str
    model : (n_times, 4) ndarray
        Share of each group on its side [1].
    curves : (n_realisations, n_times, 4) ndarray
        Of the DEM at the same times, the main run first.

    Returns
    -------
    list of dict
        error_signed_of_mean, error_rms_of_mean: model - mean of the realisations; a perfect model has the
        noise floor over sqrt(n_realisations). error_over_noise: rms error against the main run over the
        noise floor; 1 is what the exact mean of the bed would have.
    """
    floor, _ = noise_floor(curves)
    error = model - curves.mean(axis=0)
    rms = np.sqrt(((model - curves[0]) ** 2).mean(axis=0))
    rows = []
    for column, (_, group) in enumerate(GROUPS):
        rows += [
            metric(f"error_signed_of_mean_{group}", source, error[:, column].mean()),
            metric(f"error_rms_of_mean_{group}", source, np.sqrt((error[:, column] ** 2).mean())),
        ]
        if floor[column] > ROUND_OFF:
            rows.append(metric(f"error_over_noise_{group}", source, rms[column] / floor[column]))
    return rows
