# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of scores.csv: scores of chains with the noise floor and an interval over starts."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bedchain.measures.lagrangian import Statistics, dispersion_error
from bedchain.studies.scan import REPLICATES
from bedchain.studies.scores.held_out import INTERVAL_SEED, HeldOut
from bedchain.studies.scores.predictions import TIMES_S, Predictions
from bedchain.uncertainty.deviations import (
    SIDES,
    band,
    distances,
    fluctuation,
    interval,
    mean_size,
    resampled,
    rms,
    signed,
)

Array = NDArray[np.float64]
Row = dict[str, Any]

# half width of the running mean about which curves fluctuate [s]
FLUCTUATION_S = 0.25


def row(
    quantity: str,
    value: float,
    time_s: float = np.nan,
    noise_floor: float = np.nan,
    unit: str = "1",
    window: str = "",
    ci: tuple[float, float] = (np.nan, np.nan),
) -> Row:
    """Row of one score.

    Parameters
    ----------
    quantity : str
    value : float
        In ``unit``.
    time_s : float
        After the start; NaN for all frames together [s].
    noise_floor : float
        The same number for the spread of the DEM between realisations; NaN where unknown.
    unit, window : str
        Window as in `HeldOut.windows`.
    ci : (float, float)
        Ends of the 95 % interval over starts and runs.

    Returns
    -------
    dict
    """
    return {
        "quantity": quantity, "time_s": time_s, "value": float(value), "ci_low": ci[0], "ci_high": ci[1],
        "noise_floor": noise_floor, "unit": unit, "window": window,
    }  # fmt: skip


def at_times(array: Array, interval_s: float) -> list[tuple[float, Array]]:
    """Curves as a whole, with the time NaN, and at each of `TIMES_S` that they reach.

    Parameters
    ----------
    array : (n_curves, n_frames, n_columns) array
        From the first frame after the start.
    interval_s : float
        Between frames [s].
    """
    frames = {time_s: round(time_s / interval_s) - 1 for time_s in TIMES_S}
    held = {time_s: frame for time_s, frame in frames.items() if 0 <= frame < array.shape[1]}
    return [(np.nan, array), *((time_s, array[:, at : at + 1]) for time_s, at in held.items())]


def score_rows(predictions: Predictions, held: HeldOut) -> list[Row]:
    """All scores of a chain, each beside the noise floor, as `row`."""
    error, errors_of_batch = (
        predictions.curves - held.curves,
        distances(predictions.densities, held.densities),
    )
    rows = []
    for window, which in held.windows().items():
        rows += curve_rows(error, held, window, which)
        rows += batch_rows(errors_of_batch, held, window, which)
        rows += fluctuation_rows(predictions.drawn, held, window, which)
    rows += lagrangian_rows(*map(list, zip(*predictions.lagrangian, strict=True)))
    rows += dispersion_rows(predictions.lagrangian)
    rows += [row(name.replace("_s", "_time"), cost, unit="s") for name, cost in predictions.cost_s.items()]
    named = [(*name.rpartition("_")[::2], value) for name, value in predictions.chain.report.items()]
    return rows + [row(f"learned_{quantity}", value, unit=unit) for quantity, unit, value in named]


def dem_rows(held: HeldOut, lagrangian: list[Statistics]) -> list[Row]:
    """Rows of the DEM, to compare the scores with: its noise floor and its fluctuations."""
    rows = [row("repeats", len(held.runs) - 1), row("starts", len(held.starts))]
    rows += spread_rows("spread_of_starts", held.deviations_of_starts(), held, "starts")
    for window in held.windows():
        rows += spread_rows("spread", held.deviations(), held, window)
        rows += fluctuation_rows(held.curves, held, window, held.windows()[window])
    return rows + lagrangian_rows(lagrangian, lagrangian)


def spread_rows(quantity: str, deviations: Array, held: HeldOut, window: str) -> list[Row]:
    """Rms of the deviations of the DEM, at `TIMES_S` and over all frames after the start."""
    which = held.floor_of(window)
    weights, rows = held.weights(which), []
    for side, columns in SIDES.items():
        for time_s, picked in at_times(deviations[which, 1:][:, :, columns], held.interval_s):
            ends = interval(rms, picked, weights)
            rows.append(row(f"{quantity}_{side}", float(rms(picked)), time_s, window=window, ci=ends))
    return rows


def curve_rows(error: Array, held: HeldOut, window: str, which: NDArray[np.bool_]) -> list[Row]:
    """Signed and rms errors of the mixing curves at `TIMES_S` and over all frames after the start."""
    weights, spread = held.weights(which), held.deviations()[held.floor_of(window), 1:]
    rows = []
    kinds: tuple[tuple[str, Callable, Callable], ...] = (
        ("signed", signed, mean_size),
        ("rms", rms, rms),
    )
    for side, columns in SIDES.items():
        parts = [at_times(array[:, :, columns], held.interval_s) for array in (error[which, 1:], spread)]
        for (time_s, picked), (_, floor) in zip(*parts, strict=True):
            if not np.isfinite(picked).any():
                continue
            for name, summary, size in kinds:
                rows.append(
                    row(
                        f"error_{name}_{side}", float(summary(picked)), time_s, float(size(floor)),
                        window=window, ci=interval(summary, picked, weights),
                    )
                )  # fmt: skip
    return rows


def batch_rows(error: Array, held: HeldOut, window: str, which: NDArray[np.bool_]) -> list[Row]:
    """Total variation of the batch's density at each moment, and its mean over the moments."""
    floor, weights = held.batch_distances()[held.floor_of(window)], held.weights(which)
    times = [*zip(held.moments * held.interval_s, np.arange(held.moments.size)[:, None], strict=True)]
    rows = []
    for time_s, columns in [*times, (np.nan, np.arange(held.moments.size))]:
        picked = error[which][:, columns]
        if np.isfinite(picked).any():
            rows.append(row("batch_total_variation", float(signed(picked)), time_s,
                            float(signed(floor[:, columns])), window=window,
                            ci=interval(signed, picked, weights)))  # fmt: skip
    return rows


def fluctuation_rows(curves: Array, held: HeldOut, window: str, which: NDArray[np.bool_]) -> list[Row]:
    """Size of single curves' fluctuations about their running mean; the floor column holds the DEM's.

    The first running mean reaches back to `FLUCTUATION_S` after the start: before that, curves fall steeply.
    """
    half = max(1, round(FLUCTUATION_S / held.interval_s))
    weights, rows = held.weights(which), []
    chain, dem = (fluctuation(array[which, half:], half) for array in (curves, held.curves))
    for side, columns in SIDES.items():
        picked = chain[:, :, columns]
        if np.isfinite(picked).any():
            rows.append(row(f"fluctuation_{side}", float(rms(picked)), np.nan, float(rms(dem[:, :, columns])),
                            window=window, ci=interval(rms, picked, weights)))  # fmt: skip
    return rows


def lagrangian_rows(model: list[Statistics], dem: list[Statistics]) -> list[Row]:
    """Mean-square displacement and displacement autocorrelation at `TIMES_S`, in window ``start``.

    Parameters
    ----------
    model, dem : list of Statistics
        One for each run; the spread of the DEM over the runs (with one run over blocks of time) is the noise
        floor.

    Returns
    -------
    list of dict
    """
    run = np.repeat(np.arange(len(model)), [len(of_run.squared_m2) for of_run in model])
    weights = resampled(run, REPLICATES, np.random.default_rng(INTERVAL_SEED))
    rows = []
    for column, axis in enumerate("xz"):
        for time_s in [time for time in TIMES_S if time <= model[0].times_s[-1] + 1e-9]:
            squared, product, whole = (_values(model, name, at, column) for name, at in _wanted(time_s))
            spreads = [_values(dem, name, at, column) for name, at in _wanted(time_s)]
            drawn = weights / weights.sum(axis=1, keepdims=True)
            rows += [
                row(f"msd_{axis}", squared.mean(), time_s, _spread(spreads[0], run), "m2", "start",
                    _ends(drawn @ squared)),
                row(f"autocorrelation_{axis}", product.mean() / whole.mean(), time_s,
                    _spread(spreads[1] / spreads[2].mean(), run), "1", "start",
                    _ends((drawn @ product) / (drawn @ whole))),
            ]  # fmt: skip
    return rows


def dispersion_rows(pairs: list[tuple[Statistics, Statistics]]) -> list[Row]:
    """Relative error of the dispersion by height; without repeats it has no noise floor.

    Parameters
    ----------
    pairs : list of (model, dem) Statistics
        One for each run.

    Returns
    -------
    list of dict
        dispersion_error_signed and _rms along x and z, over the DEM's mean coefficient [1].
    """
    errors = np.array([dispersion_error(*pair) for pair in pairs])
    dems = [dem for _, dem in pairs]
    others = [dispersion_error(first, second) for first in dems for second in dems if first is not second]
    # two runs differ by sqrt(2) times the difference of a run from the mean of all
    floor = np.sqrt((np.array(others) ** 2).mean(axis=0) / 2) if others else np.full((2, 2), np.nan)
    rows = []
    for kind, name in enumerate(("signed", "rms")):
        for column, axis in enumerate("xz"):
            values = errors[:, kind, column]
            ends = (np.nan, np.nan)
            if len(values) > 1:
                rng = np.random.default_rng(INTERVAL_SEED)
                ends = _ends(rng.choice(values, (REPLICATES, len(values))).mean(axis=1))
            rows.append(row(f"dispersion_error_{name}_{axis}", values.mean(), pairs[0][0].span_s,
                            float(floor[kind, column]), "1", "start", ends))  # fmt: skip
    return rows


def _wanted(time_s: float) -> tuple[tuple[str, float], ...]:
    return ("squared_m2", time_s), ("product_m2", time_s), ("product_m2", 0.0)


def _values(runs: list[Statistics], name: str, time_s: float, column: int) -> Array:
    """A statistic of each block of each run, interpolated linearly in time."""
    return np.array(
        [np.interp(time_s, run.times_s, block[:, column]) for run in runs for block in getattr(run, name)]
    )


def _ends(samples: Array) -> tuple[float, float]:
    low, high = band(samples)
    return float(low), float(high)


def _spread(values: Array, run: NDArray[np.int64]) -> float:
    """Standard deviation of the means of runs, or of blocks with a single run."""
    means = np.array([values[run == number].mean() for number in np.unique(run)])
    return float(np.std(means if means.size > 1 else values, ddof=1))
