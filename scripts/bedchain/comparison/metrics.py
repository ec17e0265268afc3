# SPDX-License-Identifier: GPL-3.0-or-later
"""The chains against the DEM: curves in long form, and numbers that say how well they agree."""

import json
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.comparison.curves import curve_errors
from bedchain.errors import UserError
from bedchain.measures.batch import total_variation
from bedchain.measures.mixing import GROUPS
from bedchain.uncertainty.bands import (
    BAND_SEED,
    REPLICATES,
    band,
    block_means,
    block_steps,
    correlation_steps,
)
from bedchain.uncertainty.noise_floor import ROUND_OFF, noise_floor

Metric = dict[str, Any]


def metric(quantity: str, source: str, value: float, unit: str = "1") -> Metric:
    """One row of metrics.csv, without an interval.

    Parameters
    ----------
    quantity, source : str
    value : float
        In ``unit``.
    unit : str

    Returns
    -------
    dict
    """
    return {
        "quantity": quantity, "source": source, "value": float(value), "unit": unit,
        "ci_low": np.nan, "ci_high": np.nan,
    }  # fmt: skip


def dem_metrics(on_side: np.ndarray, remaining: np.ndarray) -> list[Metric]:
    """Shares of the bed on each side, and how much of each group has crossed at the end.

    Parameters
    ----------
    on_side : (n_times, 4) ndarray
        Share of all particles on each side [1].
    remaining : (n_times, 4) ndarray
        Share of each marked group on its side [1].

    Returns
    -------
    list of dict
    """
    rows = []
    for column, (_, group) in enumerate(GROUPS):
        rows += [
            metric(f"share_start_{group}", "dem", on_side[0, column]),
            metric(f"share_end_{group}", "dem", on_side[-1, column]),
            metric(f"share_mean_{group}", "dem", on_side[:, column].mean()),
            metric(f"crossed_end_{group}", "dem", 1 - remaining[-1, column]),
        ]
    return rows


def model_metrics(
    source: str, model: np.ndarray, dem: np.ndarray, replicates: np.ndarray | None = None
) -> list[Metric]:
    """Errors of a chain's curves over the comparison window, and the share that crossed.

    Parameters
    ----------
    source : str
    model, dem : (n_times, 4) ndarray
        Share of each group on its side, at the same times [1].
    replicates : (n_replicates, n_times, 4) ndarray, optional
        Curves of chains learned again on blocks of time; they give the 95 % bands.

    Returns
    -------
    list of dict
        error_signed (mean of model - DEM), error_rms, crossed_end, each by group.
    """
    values = curve_errors(model, dem)
    bands = (
        {}
        if replicates is None
        else {name: band(found) for name, found in curve_errors(replicates, dem).items()}
    )
    rows = []
    for column, (_, group) in enumerate(GROUPS):
        for name, value in values.items():
            row = metric(f"{name}_{group}", source, value[column])
            if name in bands:
                low, high = bands[name]
                row |= {"ci_low": float(low[column]), "ci_high": float(high[column])}
            rows.append(row)
    return rows


def batch_metrics(source: str, moments_s: np.ndarray, model: np.ndarray, dem: np.ndarray) -> list[Metric]:
    """How far a chain's distribution of the batch is from the DEM's own at each moment.

    Parameters
    ----------
    source : str
    moments_s : (n_moments,) ndarray
        [s].
    model, dem : (n_moments, n_cells) ndarray
        Shares of the batch [1].

    Returns
    -------
    list of dict
        batch_total_variation at each moment, and their mean.
    """
    distances = [total_variation(one, two) for one, two in zip(model, dem, strict=True)]
    rows = [
        metric(f"batch_total_variation_{moment:.2f}_s", source, distance)
        for moment, distance in zip(moments_s, distances, strict=True)
    ]
    return [*rows, metric("batch_total_variation_mean", source, float(np.mean(distances)))]


def report_metrics(source: str, report: str) -> list[Metric]:
    """What learning found of a chain, its units taken from the ends of the names.

    Parameters
    ----------
    source : str
    report : str
        Json of ``{"<quantity>_<unit>": value}``.

    Returns
    -------
    list of dict
    """
    named = [(*name.rpartition("_")[::2], value) for name, value in json.loads(report).items()]
    return [metric(quantity, source, value, unit) for quantity, unit, value in named]


def bed_metrics(series: pd.DataFrame, weight_Pa: float, start_s: float, end_s: float) -> list[Metric]:
    """Pressure drop and height of the bed, or height and inclination of a drum's, means over a window.

    Parameters
    ----------
    series : DataFrame
        Of `read_series`.
    weight_Pa : float
        Weight over the bed's cross section [Pa].
    start_s, end_s : float
        The window [s].

    Returns
    -------
    list of dict

    Raises
    ------
    UserError
        No time of the series is in the window.
    """
    part = series[(series["time_s"] >= start_s) & (series["time_s"] <= end_s)]
    if part.empty:
        raise UserError(f"bed_series.csv has no time from {start_s:g} s to {end_s:g} s; run run_dem again")
    height = mean_metric("particle_height_mean", part["mean_height_m"].to_numpy(), "m")
    if "surface_angle_rad" in series:
        return [height, mean_metric("surface_angle_mean", part["surface_angle_rad"].to_numpy(), "rad")]
    pressure = part["pressure_drop_Pa"].to_numpy()
    return [
        mean_metric("pressure_drop_mean", pressure, "Pa"),
        metric("weight_per_area", "dem", weight_Pa, "Pa"),
        mean_metric("pressure_drop_over_weight", pressure / weight_Pa, "1"),
        height,
        metric("voidage_smallest", "dem", series["smallest_voidage_1"].min()),
        metric("voidage_clips", "dem", series["voidage_clips_1"].sum()),
        metric("volume_balance_largest", "dem", series["volume_balance_1"].abs().max()),
        metric("exchange_error_largest", "dem", series["exchange_error_1"].abs().max()),
    ]


def mean_metric(quantity: str, series: np.ndarray, unit: str) -> Metric:
    """Mean over time with the 95 % band of means over moving blocks.

    Parameters
    ----------
    quantity : str
    series : (n_times,) ndarray
        In ``unit``, evenly spaced in time.
    unit : str

    Returns
    -------
    dict
    """
    block = block_steps(correlation_steps(series), len(series))
    means = block_means(series, block, REPLICATES, np.random.default_rng(BAND_SEED))
    low, high = (float(end) for end in band(means))
    return metric(quantity, "dem", float(series.mean()), unit) | {"ci_low": low, "ci_high": high}


def floor_metrics(curves: NDArray[np.float64]) -> list[Metric]:
    """Noise floor of each group, and how many realisations it is from.

    Parameters
    ----------
    curves : (n_realisations, n_times, 4) ndarray
        From the start on [1].

    Returns
    -------
    list of dict
    """
    floor, (low, high) = noise_floor(curves[:, 1:])
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
    floor, _ = noise_floor(curves[:, 1:])
    of_mean, of_run = curve_errors(model, curves.mean(axis=0)), curve_errors(model, curves[0])
    rows = []
    for column, (_, group) in enumerate(GROUPS):
        rows += [
            metric(f"{name}_of_mean_{group}", source, of_mean[name][column])
            for name in ("error_signed", "error_rms")
        ]
        if floor[column] > ROUND_OFF:
            over = of_run["error_rms"][column] / floor[column]
            rows.append(metric(f"error_over_noise_{group}", source, over))
    return rows
