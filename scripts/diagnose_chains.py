# SPDX-License-Identifier: GPL-3.0-or-later
"""What the chains imply and how far they hold: results/<case>/diagnostics.csv."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from bedchain.chains import registry
from bedchain.chains.chain import Chain
from bedchain.chains.counting import count_moves
from bedchain.chains.estimators import visited_density
from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.passage import top_row
from bedchain.comparison.diagnostics import (
    Row,
    arrival_row,
    dispersion_rows,
    estimator_rows,
    lacey_rows,
    row,
    table,
    time_rows,
)
from bedchain.comparison.forecasts import count_sides
from bedchain.comparison.markov_test import check_model, counted_rows, doubled_lags
from bedchain.files import write_csv
from bedchain.measures.batch import total_variation
from bedchain.measures.mixing import marked_histogram, sides
from bedchain.stage import LOG, stage
from bedchain.trajectory.frames import Frames, lag_frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import open_realisation
from bedchain.uncertainty.bands import block_length

# the top of the bed, for passages from its bottom: reached by this share of the particles at a time
TOP_SHARE = 0.05
# mixing is followed for this part of the learning window, so that many frames are starts
FOLLOWED_SHARE = 0.5
# moments of the comparison window at which Lacey's index is given
LACEY_MOMENTS = 40
# every other one of the lags is enough for dispersion coefficients
DISPERSION_STRIDE = 2
# their long-run densities come with the comparison of the estimators
PAPER_MODELS = ("static", "dynamic")
REPORTED = ("mixing_time", "long_run_total_variation", "chapman_kolmogorov_rms")


def diagnose_chains(
    trajectory: Path, metadata: Path, cells: Path, transitions: dict[str, Path], diagnostics: Path,
    learning: dict[str, float], comparison: dict[str, float],
    split_x_m: float, split_z_m: float, estimator: str, seed: int,
    options: dict[str, dict[str, Any]] | None = None,
) -> None:  # fmt: skip
    """Test the chains on their own learning window, and read from them what they imply for the bed.

    Models without a transition matrix have no timescales: of them only what particles do is given.

    Parameters
    ----------
    trajectory, metadata, cells : Path
        ``trajectory.npy``, ``trajectory.json``, ``cells.npz``.
    transitions : dict of str to Path
        ``transitions_<model>.npz`` by model.
    diagnostics : Path
        Table to make; its rows are those of `bedchain.diagnosis` and `bedchain.markov_check`.
    learning, comparison : dict of str to float
        ``start_s`` and ``end_s`` of each window [s].
    split_x_m, split_z_m : float
        Lines between left and right, low and up [m].
    estimator : {"literal", "per_step", "pooled"}
        How counts become probabilities.
    seed : int
        Of the blocks and of the particles' paths.
    options : dict of str to dict, optional
        Settings of each model only.
    """
    bed = open_realisation("the run", trajectory, metadata, cells)
    chains = {name: registry.load(path) for name, path in transitions.items()}
    with_matrix = {name: chain for name, chain in chains.items() if isinstance(chain, MarkovChain)}
    if absent := [name for name in chains if name not in with_matrix]:
        LOG.info("no transition matrix, so no timescales and no consistency: %s", ", ".join(absent))
    frames = bed.window(learning["start_s"], learning["end_s"])
    lag = lag_frames(next(iter(chains.values())).lag_s, frames.interval_s)
    lags = doubled_lags(lag, len(frames.times_s))
    longest = max(lags[-1], int(FOLLOWED_SHARE * len(frames.times_s)) // lag * lag)
    looks = count_sides(frames, split_x_m, split_z_m, range(lag, longest + 1, lag))
    block = block_length(frames, split_x_m, lag)
    random = iter(np.random.default_rng(seed).spawn(1 + 3 * len(chains)))
    density = visited_density(count_moves(frames.cells, bed.grid.n_cells, lag))
    top = top_row(density, bed.grid, TOP_SHARE)

    rows = estimator_rows(frames, bed.grid, lag, list(chains))
    rows += counted_rows(looks, frames, block, next(random))
    for name in with_matrix:
        own = (options or {}).get(name, {})
        rows += check_model(name, frames, bed.grid, looks, lags, estimator, block, next(random), own)
    rows += path_rows("dem", frames, bed.grid, top, lags)
    known = in_cells(frames.times_s, frames.cells, bed.grid)
    rows += dispersion_rows("dem_cells", known, bed.grid, lags[::DISPERSION_STRIDE])
    before = bed.up_to(learning["start_s"], lag)
    for name, chain in chains.items():
        if name not in PAPER_MODELS:
            distance = total_variation(chain.long_run_density(before), density)
            where = {"lag_s": chain.lag_s, "part": estimator}
            rows.append(row("long_run_total_variation", name, distance, **where))
        if name in with_matrix:
            matrix_chain = with_matrix[name]
            held = np.bincount(matrix_chain.states(before), minlength=matrix_chain.matrix.shape[0])
            rows += time_rows(matrix_chain, held.astype(float), 1 / frames.cells.shape[1], top)
        times = frames.times_s[::lag]
        paths = np.array([now.copy() for now in chain.paths(before, len(times) - 1, next(random))])
        steps = [one // lag for one in lags]
        rows += path_rows(name, in_cells(times, paths, bed.grid), bed.grid, top, steps)
    start = bed.up_to(comparison["start_s"], lag)
    window = bed.window(comparison["start_s"], comparison["end_s"])
    rows += index_rows(chains, start, window, (split_x_m, split_z_m), lag, random)
    write_csv(table(rows), diagnostics)
    for one in rows:
        if one["quantity"] in REPORTED and one["lag_s"] == lag * frames.interval_s:
            what = f"{one['source']} {one['part']} {one['quantity']}"
            LOG.info("%s: %.4g %s", what, one["value"], one["unit"])


def path_rows(source: str, frames: Frames, grid: Grid, top: int, lags: Sequence[int]) -> list[Row]:
    """Arrivals at the top and dispersion coefficients of particles followed from frame to frame."""
    rows = [arrival_row(source, frames, grid, top)]
    return rows + dispersion_rows(source, frames, grid, lags[::DISPERSION_STRIDE])


def in_cells(times_s: np.ndarray, cells: np.ndarray, grid: Grid) -> Frames:
    """Frames in which every particle is in the middle of its cell, all that a chain of cells knows."""
    x, z = grid.centres_m.astype(np.float32).T
    return Frames(times_s, x[cells], z[cells], np.asarray(cells))


def index_rows(
    chains: dict[str, Chain], start: Frames, window: Frames, splits: tuple[float, float], lag: int,
    random: Iterator[np.random.Generator],
) -> list[Row]:  # fmt: skip
    """Lacey's index over the comparison window, by the DEM and by as many particles of each chain.

    Parameters
    ----------
    chains : dict of str to Chain
    start : Frames
        Up to the start of the comparison.
    window : Frames
        The comparison window.
    splits : (float, float)
        Lines between left and right, low and up [m].
    lag : int
        Frames in a step of the chains.
    random : iterator of numpy Generator
        One for each chain.

    Returns
    -------
    list of dict
    """
    marked = sides(np.asarray(start.x_m[-1]), np.asarray(start.z_m[-1]), *splits)
    first = next(iter(chains.values()))
    n_steps = (len(window.times_s) - 1) // lag
    steps = np.unique(np.linspace(0, n_steps, min(n_steps, LACEY_MOMENTS) + 1).astype(int))
    times = steps * first.lag_s
    seen = [marked_histogram(window.cells[step * lag], marked, first.grid.n_cells) for step in steps]
    rows = lacey_rows("dem", times, np.array(seen))
    for name, chain in chains.items():
        rows += lacey_rows(name, times, chain.densities(start, marked, list(steps), next(random)))
    return rows


if "snakemake" in globals():
    with stage(snakemake.log[0]):
        diagnose_chains(
            Path(snakemake.input.trajectory),
            Path(snakemake.input.metadata),
            Path(snakemake.input.cells),
            dict(zip(snakemake.params.models, map(Path, snakemake.input.transitions), strict=True)),
            Path(snakemake.output.diagnostics),
            snakemake.params.learning,
            snakemake.params.comparison,
            snakemake.params.split_x_m,
            snakemake.params.split_z_m,
            snakemake.params.estimator,
            snakemake.params.seed,
            snakemake.params.options,
        )
