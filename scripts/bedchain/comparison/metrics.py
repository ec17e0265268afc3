# SPDX-License-Identifier: GPL-3.0-or-later
"""Metrics of the bed and of the chains' errors: rows of metrics.csv."""

import json
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.comparison.curves import curve_errors
from bedchain.errors import UserError
from bedchain.measures.mixing import GROUPS
from bedchain.uncertainty.bands import block_band, correlation_steps, means_left_out
from bedchain.uncertainty.noise_floor import ROUND_OFF, floor_of, noise_floor

Metric = dict[str, Any]

# kinds of the errors of curves, for their bands
SCALE = {"error_signed": "plain", "error_rms": "positive", "crossed_end": "share"}


def metric(
    quantity: str,
    source: str,
    value: float,
    unit: str = "1",
    ci_low: float = np.nan,
    ci_high: float = np.nan,
    **where: Any,
) -> Metric:
    """Row of a long table of values, such as metrics.csv or diagnostics.csv.

    Parameters
    ----------
    quantity, source : str
    value : float
        In ``unit``.
    unit : str
    ci_low, ci_high : float
        Ends of the 95 % interval, in ``unit``; NaN for none.
    **where
        Further columns of the table, such as time_s.

    Returns
    -------
    dict
    """
    return {
        "quantity": quantity, "source": source, "value": float(value), "unit": unit,
        "ci_low": float(ci_low), "ci_high": float(ci_high), **where,
    }  # fmt: skip


def dem_metrics(on_side: np.ndarray, remaining: np.ndarray) -> list[Metric]:
    """Share of the bed on each side, and share of each group that has crossed at the end.

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
    source: str, model: np.ndarray, dem: np.ndarray, left_out: np.ndarray | None = None
) -> list[Metric]:
    """Errors of a chain's curves over the comparison window, and the share that has crossed at its end.

    Parameters
    ----------
    source : str
    model, dem : (n_times, 4) ndarray
        Share of each group on its side, at the same times [1].
    left_out : (BLOCKS, n_times, 4) ndarray, optional
        Curves of chains learned without each block of time, for 95 % bands; none in a window too short.

    Returns
    -------
    list of dict
        error_signed (mean of model - DEM), error_rms, crossed_end, each by group.
    """
    values = curve_errors(model, dem)
    if left_out is None:
        bands = dict.fromkeys(values, np.full((2, len(GROUPS)), np.nan))
    else:
        without = curve_errors(left_out, dem)
        bands = {name: np.array(block_band(values[name], without[name], SCALE[name])) for name in values}
    return [
        metric(f"{name}_{group}", source, value[column], "1", *bands[name][:, column])
        for column, (_, group) in enumerate(GROUPS)
        for name, value in values.items()
    ]


def batch_metrics(
    source: str,
    moments_s: np.ndarray,
    model: np.ndarray,
    dem: np.ndarray,
    left_out: np.ndarray | None = None,
) -> list[Metric]:
    """Total variation of a chain's distribution of the batch from the DEM's at each moment.

    Parameters
    ----------
    source : str
    moments_s : (n_moments,) ndarray
        [s].
    model, dem : (n_moments, n_cells) ndarray
        Shares of the batch [1].
    left_out : (BLOCKS, n_moments, n_cells) ndarray, optional
        By chains learned without each block of time, for 95 % bands; none in a window too short.

    Returns
    -------
    list of dict
        batch_total_variation at each moment, and their mean.
    """
    distance = batch_distances(model, dem)
    without = np.empty((0, distance.size)) if left_out is None else batch_distances(left_out, dem)
    ends = np.stack(block_band(distance, without, "share"), axis=1)
    names = [*(f"batch_total_variation_{moment:.2f}_s" for moment in moments_s), "batch_total_variation_mean"]
    return [
        metric(name, source, value, "1", *band)
        for name, value, band in zip(names, distance, ends, strict=True)
    ]


def batch_distances(model: np.ndarray, dem: np.ndarray) -> np.ndarray:
    """Total variation at each moment, and their mean: (..., n_moments, n_cells) to (..., n_moments + 1)."""
    distance = 0.5 * np.abs(model - dem).sum(axis=-1)
    return np.concatenate((distance, distance.mean(axis=-1, keepdims=True)), axis=-1)


def report_metrics(source: str, report: str) -> list[Metric]:
    """Numbers of the report of a chain, with units from the ends of their names.

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
    """Means over a window: pressure drop and height of a bed, height and inclination of a drum's, or height.

    Parameters
    ----------
    series : DataFrame
        From `dem.series.read_series`.
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
        The series has no time in the window.
    """
    part = series[(series["time_s"] >= start_s) & (series["time_s"] <= end_s)]
    if part.empty:
        raise UserError(f"bed_series.csv has no time from {start_s:g} s to {end_s:g} s; run run_dem again")
    height = mean_metric("particle_height_mean", part["mean_height_m"].to_numpy(), "m")
    if "surface_angle_rad" in series:
        return [height, mean_metric("surface_angle_mean", part["surface_angle_rad"].to_numpy(), "rad")]
    if "pressure_drop_Pa" not in series:
        return [height]
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
    """Mean over time with its 95 % band, without one if the series is too short to know it.

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
    times = len(series) / correlation_steps(series)
    low, high = block_band(series.mean(), means_left_out(series), "plain", times)
    return metric(quantity, "dem", series.mean(), unit, float(low), float(high))


def floor_metrics(curves: NDArray[np.float64]) -> list[Metric]:
    """Noise floor of each group, and the number of realisations.

    Parameters
    ----------
    curves : (n_realisations, n_times, 4) ndarray
        From the start on [1].

    Returns
    -------
    list of dict
    """
    floor, (low, high) = noise_floor(curves[:, 1:])
    columns = zip(GROUPS, floor, low, high, strict=True)
    floors = [
        metric(f"noise_floor_{group}", "dem", value, "1", *ends) for (_, group), value, *ends in columns
    ]
    return [metric("realisations", "dem", len(curves)), *floors]


def noise_metrics(source: str, model: NDArray[np.float64], curves: NDArray[np.float64]) -> list[Metric]:
    """Errors of a chain against the mean of the realisations, and as multiples of the noise floor.

    Parameters
    ----------
    source : str
    model : (n_times, 4) ndarray
        Share of each group on its side [1].
    curves : (n_realisations, n_times, 4) ndarray
        Of the DEM, at the same times, the main run first [1].

    Returns
    -------
    list of dict
        error_signed_of_mean, error_rms_of_mean: model - mean of the realisations; the rms of a perfect model
        is the noise floor over sqrt(n_realisations). error_over_noise: rms error against the main run over
        the noise floor; it is 1 for the exact mean of the bed. error_over_noise_mixing: the same of all four
        curves against each realisation; it is 1.41 of another realisation.
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
    if (of_all := floor_of(curves[:, 1:])) > ROUND_OFF:
        error = np.sqrt(np.mean((model[1:] - curves[:, 1:]) ** 2))
        rows.append(metric("error_over_noise_mixing", source, error / of_all))
    return rows
