# SPDX-License-Identifier: GPL-3.0-or-later
"""The chains against the DEM: curves in long form, and numbers that say how well they agree."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from bedchain.bootstrap import band, block_means, correlation_steps
from bedchain.diagnostics import total_variation
from bedchain.errors import UserError
from bedchain.mixing import GROUPS

Metric = dict[str, Any]
SERIES_COLUMNS = ("time_s", "mean_height_m")
GAS_COLUMNS = (
    "pressure_drop_Pa",
    "smallest_voidage_1",
    "voidage_clips_1",
    "volume_balance_1",
    "exchange_error_1",
)
# blocks several times as long as the bed remembers, but at least this many of them in the window
BLOCK_CORRELATIONS, FEWEST_BLOCKS = 3, 5
REPLICATES = 400
# of the bands only: the same data give the same band
BAND_SEED = 11


def curve_table(times_s: np.ndarray, source: str, remaining: np.ndarray) -> pd.DataFrame:
    """Curves of one source as rows of mixing.csv.

    Parameters
    ----------
    times_s : (n_times,) ndarray
        [s].
    source : str
        ``dem``, a model, or a model with ``_monte_carlo``.
    remaining : (n_times, 4) ndarray
        Share of each group of `mixing.GROUPS` that is on its side [1].

    Returns
    -------
    DataFrame
        time_s, source, direction, group, fraction_remaining_1.
    """
    parts = [
        pd.DataFrame(
            {
                "time_s": times_s,
                "source": source,
                "direction": direction,
                "group": group,
                "fraction_remaining_1": remaining[:, column],
            }
        )
        for column, (direction, group) in enumerate(GROUPS)
    ]
    return pd.concat(parts, ignore_index=True)


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


def curve_errors(model: np.ndarray, dem: np.ndarray) -> dict[str, np.ndarray]:
    """Numbers that sum up how curves differ from the DEM's.

    Parameters
    ----------
    model : (..., n_times, 4) ndarray
        Share of each group on its side [1].
    dem : (n_times, 4) ndarray

    Returns
    -------
    dict of str to (..., 4) ndarray
        error_signed, error_rms, crossed_end [1].
    """
    error = model - dem
    return {
        "error_signed": error.mean(axis=-2),
        "error_rms": np.sqrt((error**2).mean(axis=-2)),
        "crossed_end": 1 - model[..., -1, :],
    }


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


def read_series(path: Path) -> pd.DataFrame:
    """What the solver wrote of the bed as a whole, step by step.

    Parameters
    ----------
    path : Path
        ``bed_series.csv``.

    Returns
    -------
    DataFrame
        With the columns of `SERIES_COLUMNS`, and where there is gas with those of `GAS_COLUMNS`.

    Raises
    ------
    UserError
        A column is missing.
    """
    try:
        table = pd.read_csv(path)
    except (OSError, ValueError) as error:
        raise UserError(f"{path}: not readable ({error}); run run_dem again") from error
    needed = SERIES_COLUMNS if "surface_angle_rad" in table else (*SERIES_COLUMNS, *GAS_COLUMNS)
    missing = [name for name in needed if name not in table]
    if missing:
        raise UserError(f"{path} has no column {', '.join(missing)}; run run_dem again")
    return table


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
    block = int(min(BLOCK_CORRELATIONS * correlation_steps(series), max(1, len(series) // FEWEST_BLOCKS)))
    means = block_means(series, max(1, block), REPLICATES, np.random.default_rng(BAND_SEED))
    low, high = (float(end) for end in band(means))
    return metric(quantity, "dem", float(series.mean()), unit) | {"ci_low": low, "ci_high": high}
