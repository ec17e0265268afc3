# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties of a bed and of its chains, as rows of diagnostics.csv."""

from collections.abc import Iterable, Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.chains import dynamic, static
from bedchain.chains.counting import Counts, count_pairs
from bedchain.chains.estimators import ESTIMATORS, estimated_rows, visited_density
from bedchain.chains.first_passage import passage_distribution
from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.passage import arrived, passage_time, residence_in_cells
from bedchain.comparison.metrics import Metric, metric
from bedchain.measures.batch import total_variation
from bedchain.measures.dispersion import dispersion_by_height
from bedchain.measures.mixing import lacey_index
from bedchain.trajectory.frames import Frames, Lag
from bedchain.trajectory.grid import Grid
from bedchain.uncertainty.bands import Array, block_band

# part: a group, a direction, an estimator or a number
COLUMNS = (
    *("quantity", "source", "lag_s", "time_s", "height_m", "part"),
    *("value", "unit", "ci_low", "ci_high"),
)
# layers with fewer displacements have no dispersion coefficient
FEWEST_DISPLACEMENTS = 100
# quantities of `times_of`, and their parts
TIMES = (
    *(("residence_time", part) for part in ("mean", "shortest", "longest")),
    ("first_passage_time", ""),
)
# marked groups of Lacey's index, by direction
MARKED = {"radial": 0, "axial": 2}


def table(rows: Iterable[Metric]) -> pd.DataFrame:
    """Rows as a table with the columns of diagnostics.csv."""
    return pd.DataFrame(list(rows), columns=list(COLUMNS))


def estimator_rows(frames: Frames, grid: Grid, single: Counts, models: Sequence[str]) -> list[Metric]:
    """Row sums, leak and long-run density of each estimator, for the static and the dynamic chain.

    Parameters
    ----------
    frames : Frames
        The learning window.
    grid : Grid
    single : Counts
        From `count_moves`, of that window.
    models : sequence of str
        Names other than ``static`` and ``dynamic`` are ignored.

    Returns
    -------
    list of dict
        row_sum_error, leak, long_run_total_variation (from the frames' mean density); part = estimator.
    """
    lag = single.lag
    reports = {"static": static.compare_estimators(single)} if "static" in models else {}
    if "dynamic" in models:
        double = count_pairs(frames.cells, grid.n_cells, lag)
        visited = double.visits > 0
        reports["dynamic"] = {}
        for estimator in ESTIMATORS:
            sums = np.asarray(estimated_rows(double, estimator).sum(axis=1)).ravel()[visited]
            chain = dynamic.from_counts(double, single, grid, lag * frames.interval_s, estimator)
            reports["dynamic"][estimator] = chain.report | {
                "row_sum_error_1": float(np.abs(sums - 1).max()),
                "long_run_total_variation_1": total_variation(
                    chain.long_run_density(frames), visited_density(single)
                ),
            }
    return [
        metric(name, model, values[f"{name}_1"], lag_s=lag * frames.interval_s, part=estimator)
        for model, by_estimator in reports.items()
        for estimator, values in by_estimator.items()
        for name in ("row_sum_error", "leak", "long_run_total_variation")
    ]


def times_of(chain: MarkovChain, start: NDArray[np.float64], least_share: float, top: int) -> Array:
    """Residence times and passage time from the bottom to the top.

    Parameters
    ----------
    chain : MarkovChain
    start : (n_states,) array
        Particles in each state at the start [1].
    least_share : float
        Least long-run share of a cell that counts for the residence times: that of one particle [1].
    top : int
        Row of cells to reach from the bottom row.

    Returns
    -------
    (4,) array
        In the order of `TIMES` [s]; NaN where no cell is ever left, and where some particles never reach the
        top.
    """
    residence, density = residence_in_cells(chain, start)
    usual = (density >= least_share) & np.isfinite(residence)
    times = np.full(len(TIMES), np.nan)
    if usual.any():
        mean = (residence[usual] * density[usual]).sum() / density[usual].sum()
        times[:3] = mean, residence[usual].min(), residence[usual].max()
    passage = passage_time(chain, start, top)
    times[3] = passage if np.isfinite(passage) and chain.grid.rows_are_heights else np.nan
    return times


def time_rows(source: str, lag_s: float, height_m: float, times: Array, left_out: Array) -> list[Metric]:
    """Rows of residence and passage times that there are, with their bands.

    Parameters
    ----------
    source : str
    lag_s : float
        Of the chain [s].
    height_m : float
        Of the row to reach [m].
    times : (4,) array
        From `times_of` [s].
    left_out : (BLOCKS, 4) array
        Of chains learned without each block of time; none in a window too short for a band [s].

    Returns
    -------
    list of dict
        residence_time (part: mean over the particles, shortest and longest of the cells),
        first_passage_time.
    """
    bands = zip(TIMES, times, *block_band(times, left_out, "positive"), strict=True)
    return [
        metric(quantity, source, time, "s", *band, lag_s=lag_s)
        | ({"part": part} if part else {"height_m": height_m})
        for (quantity, part), time, *band in bands
        if np.isfinite(time)
    ]


def arrival_row(source: str, frames: Frames, grid: Grid, top: int) -> Metric:
    """Share of the bottom row's particles that reach the row ``top`` by the end of the frames."""
    share = float(arrived(frames.cells, grid, top)[-1])
    length = float(frames.times_s[-1] - frames.times_s[0])
    return share_row(source, length, top * grid.cell_height_m, share, np.empty(0))


def share_row(source: str, time_s: float, height_m: float, share: float, left_out: Array) -> Metric:
    """Row of the share that has reached a height [m] after a time [s], with its band.

    Parameters
    ----------
    source : str
    time_s, height_m : float
    share : float
        [1].
    left_out : (BLOCKS,) array
        By chains learned without each block of time; none of a single realisation [1].
    """
    ends = map(float, block_band(share, left_out, "share"))
    return metric("first_passage_share", source, share, "1", *ends, time_s=time_s, height_m=height_m)


def arrived_share(chain: MarkovChain, start: NDArray[np.float64], top: int, n_steps: int) -> float:
    """Share of the bottom row's particles that a chain takes to the row ``top`` within some steps.

    Parameters
    ----------
    chain : MarkovChain
    start : (n_states,) array
        Particles in each state at the start; those in the bottom row count.
    top : int
    n_steps : int

    Returns
    -------
    float
        [1]; NaN without particles at the bottom, and where rows are no heights.
    """
    row_of_state = chain.grid.indices(chain.cell_of_state)[1]
    at_bottom = np.where(row_of_state == 0, start, 0.0)
    if not (chain.grid.rows_are_heights and at_bottom.sum() > 0):
        return float("nan")
    of_steps = passage_distribution(chain.matrix, row_of_state >= top, at_bottom / at_bottom.sum(), n_steps)
    return float(of_steps.sum())


def dispersion_rows(
    source: str, frames: Frames, grid: Grid, lags: Sequence[int], correlation_times: float = 0.0
) -> list[Metric]:  # fmt: skip
    """Dispersion coefficients of each row of cells, at several lags.

    Parameters
    ----------
    source : str
    frames : Frames
        Of the DEM, or of a chain with particles in the centres of their cells.
    grid : Grid
    lags : sequence of int
        Frames in a displacement.
    correlation_times : float
        In the frames, for bands by leaving five blocks of them out; none of a chain's particles, which show
        their own scatter and not that of what was learned [1].

    Returns
    -------
    list of dict
        dispersion_x and dispersion_z [m2/s] of layers with `FEWEST_DISPLACEMENTS`.
    """
    rows = []
    for lag in lags:
        lag_s = lag * frames.interval_s
        layers = dispersion_by_height(frames.x_m, frames.z_m, grid.heights_m, Lag(lag, lag_s))
        for layer in np.flatnonzero(layers.displacements >= FEWEST_DISPLACEMENTS):
            for column, axis in enumerate("xz"):
                value, where = layers.dispersion_m2_s[layer, column], {"height_m": layers.height_m[layer]}
                without = layers.left_out_m2_s[:, layer, column]
                ends = map(float, block_band(value, without, "positive", correlation_times))
                rows.append(metric(f"dispersion_{axis}", source, value, "m2/s", *ends, lag_s=lag_s, **where))
    return rows


def lacey_indices(numbers: np.ndarray) -> Array:
    """Lacey's index of the left and of the low particles over time.

    Parameters
    ----------
    numbers : (n_times, 4, n_cells) array
        Particles of each group of `mixing.GROUPS` in each cell [1].

    Returns
    -------
    (2, n_times) array
        In the order of `MARKED` [1].
    """
    groups = MARKED.values()
    return np.array([[lacey_index(now[at], now[at] + now[at + 1]) for now in numbers] for at in groups])


def lacey_rows(source: str, times_s: NDArray[np.float64], indices: Array, left_out: Array) -> list[Metric]:
    """Rows of `lacey_indices` with their bands.

    Parameters
    ----------
    source : str
    times_s : (n_times,) array
        [s].
    indices : (2, n_times) array
        [1].
    left_out : (BLOCKS, 2, n_times) array
        By chains learned without each block of time; none of a single realisation [1].

    Returns
    -------
    list of dict
        lacey_index, part = radial or axial.
    """
    low, high = block_band(indices, left_out)
    return [
        metric("lacey_index", source, value, "1", *ends, time_s=time, part=direction)
        for direction, *of_time in zip(MARKED, indices, low, high, strict=True)
        for time, value, *ends in zip(times_s, *of_time, strict=True)
    ]
