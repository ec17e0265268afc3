# SPDX-License-Identifier: GPL-3.0-or-later
"""Diagnostics of the chains, what they imply and how far they hold: results/<case>/diagnostics.csv."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.chains import registry
from bedchain.chains.chain import Chain
from bedchain.chains.circulation import circulation
from bedchain.chains.counting import count_moves
from bedchain.chains.counting_by_block import BlockCounts, count_move_blocks
from bedchain.chains.estimators import visited_density
from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.passage import top_row
from bedchain.chains.registry import ModelSettings
from bedchain.comparison.diagnostics import (
    TIMES,
    arrival_row,
    arrived_share,
    dispersion_rows,
    estimator_rows,
    lacey_indices,
    lacey_rows,
    share_row,
    table,
    time_rows,
    times_of,
)
from bedchain.comparison.forecasts import count_sides
from bedchain.comparison.markov_test import check_model, counted_rows, doubled_lags
from bedchain.comparison.metrics import metric
from bedchain.comparison.mode_maps import COLUMNS as MAP_COLUMNS
from bedchain.comparison.mode_maps import mode_maps, mode_rows
from bedchain.files import write_csv
from bedchain.measures.batch import total_variation
from bedchain.measures.mixing import Splits, marked_histogram, sides
from bedchain.meter import keep_freed_memory
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.frames import Frames, Window, lag_frames
from bedchain.trajectory.grid import OUTSIDE, Grid
from bedchain.trajectory.realisations import open_bed
from bedchain.trajectory.store import BedFiles
from bedchain.uncertainty.bands import Array, memory, shortness

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
NO_BAND: Array = np.empty(0)
REPORTED = ("mixing_time", "long_run_total_variation", "chapman_kolmogorov_rms")


def diagnose_chains(
    bed: BedFiles, transitions: list[Path], diagnostics: Path, modes: Path,
    learning: Window, comparison: Window, splits: Splits, settings: ModelSettings,
) -> None:  # fmt: skip
    """Test the chains on their own learning window, and read from them what they imply for the bed.

    Models without a transition matrix have no timescales: of them only what particles do is given.

    Parameters
    ----------
    bed : BedFiles
    transitions : list of Path
        ``transitions_<model>.npz`` of each model.
    diagnostics : Path
        Table to make; its rows are those of `comparison.diagnostics`, `comparison.markov_test` and
        `comparison.mode_maps`.
    modes : Path
        Table of maps to make: the slowest processes over the bed, and its circulation.
    learning, comparison : Window
    splits : Splits
    settings : ModelSettings
        Options by model.
    """
    keep_freed_memory()
    run = open_bed(bed)
    chains = {chain.name: chain for chain in map(registry.load, transitions)}
    with_matrix = {name: chain for name, chain in chains.items() if isinstance(chain, MarkovChain)}
    if absent := [name for name in chains if name not in with_matrix]:
        LOG.info("no transition matrix, so no timescales and no consistency: %s", ", ".join(absent))
    frames = run.window(learning)
    lag = lag_frames(next(iter(chains.values())).lag_s, frames.interval_s)
    lags = doubled_lags(lag, len(frames.times_s))
    longest = max(lags[-1], int(FOLLOWED_SHARE * len(frames.times_s)) // lag * lag)
    looks = count_sides(frames, *splits, range(lag, longest + 1, lag))
    remembered = memory(frames, splits.split_x_m)
    correlation_times = (len(frames.times_s) - 1) / remembered
    if short := shortness(correlation_times):
        LOG.warning("the learning window's %s", short)
    seeds = np.random.SeedSequence(settings.seed).spawn(2 * len(chains))
    of_paths, of_indices = (
        dict(zip(chains, part, strict=True)) for part in (seeds[: len(chains)], seeds[len(chains) :])
    )
    single = count_moves(frames.cells, run.grid.n_cells, lag)
    density = visited_density(single)
    top = top_row(density, run.grid, TOP_SHARE)

    rows = estimator_rows(frames, run.grid, single, list(chains))
    rows += counted_rows(looks, frames, remembered)
    before = run.up_to(learning.start_s, lag, run.grid)
    compared = run.window(comparison)
    there = np.asarray(compared.cells[0]) != OUTSIDE
    marked = sides(np.asarray(compared.x_m[0]), np.asarray(compared.z_m[0]), *splits) & there
    start = run.up_to(comparison.start_s, lag, run.grid)
    moments = moments_of((len(compared.times_s) - 1) // lag)
    asked = Asked(before, (len(frames.times_s) - 1) // lag, top, start, marked[:, there], moments)
    length_s, height_m = asked.n_steps * lag * frames.interval_s, top * run.grid.cell_height_m
    of_time = np.asarray(moments * (lag * frames.interval_s), np.float64)
    maps: list[pd.DataFrame] = []
    blocks = cache(lambda at: count_move_blocks(frames.cells, run.grid.n_cells, at))  # once for both models
    for name, markov in with_matrix.items():
        relearner = partial(relearned, name, frames, run.grid, settings, blocks)
        numbers_of = partial(asked.numbers, of_indices[name])
        checked, first = check_model(name, relearner, frames, looks, lags, remembered, numbers_of)
        stays, share, indices = zip(*map(parted, (first.whole.further, first.left_out.further)), strict=True)
        flow = circulation(first.chain, first.modes.density)
        maps.append(mode_maps(first.chain, first.modes, flow))
        rows += mode_rows(first.chain, first.modes, flow)
        rows += checked + time_rows(name, markov.lag_s, height_m, *stays)
        if np.isfinite(share[0]):
            rows.append(share_row(name, length_s, height_m, float(share[0]), share[1]))
        rows += lacey_rows(name, of_time, *indices)
    if run.grid.rows_are_heights:
        rows.append(arrival_row("dem", frames, run.grid, top))
    rows += dispersion_rows("dem", frames, run.grid, lags[::DISPERSION_STRIDE], correlation_times)
    known = in_cells(frames.times_s, frames.cells, run.grid)
    rows += dispersion_rows("dem_cells", known, run.grid, lags[::DISPERSION_STRIDE], correlation_times)
    for name, chain in chains.items():
        if name not in PAPER_MODELS:
            distance = total_variation(chain.long_run_density(before), density)
            rows.append(
                metric("long_run_total_variation", name, distance, lag_s=chain.lag_s, part=settings.estimator)
            )
        times = frames.times_s[::lag]
        random = np.random.default_rng(of_paths[name])
        paths = in_cells(
            times, np.array([now.copy() for now in chain.paths(before, len(times) - 1, random)]), run.grid
        )
        if name not in with_matrix:
            if run.grid.rows_are_heights:
                rows.append(arrival_row(name, paths, run.grid, top))
            rows += lacey_rows(name, of_time, asked.indices(of_indices[name], chain), NO_BAND)
        rows += dispersion_rows(name, paths, run.grid, [one // lag for one in lags[::DISPERSION_STRIDE]])
    seen = [marked_histogram(compared.cells[step * lag], marked, run.grid.n_cells) for step in moments]
    rows += lacey_rows("dem", of_time, lacey_indices(np.array(seen)), NO_BAND)
    write_csv(table(rows), diagnostics)
    write_csv(pd.concat(maps) if maps else pd.DataFrame(columns=list(MAP_COLUMNS)), modes)
    for one in rows:
        if one["quantity"] in REPORTED and one["lag_s"] == lag * frames.interval_s:
            what = f"{one['source']} {one.get('part', '')} {one['quantity']}"
            LOG.info("%s: %.4g %s", what, one["value"], one["unit"])


@dataclass(frozen=True)
class Asked:
    """What each chain is asked, and those that are learned without a block of time.

    Attributes
    ----------
    before : Frames
        Up to the start of the learning window.
    n_steps : int
        Steps in the learning window.
    top : int
        Row of cells to reach from the bottom row.
    start : Frames
        Up to the start of the comparison window, of the particles that are there then.
    marked : (4, n_particles) bool array
        Groups of `mixing.GROUPS` at that start.
    moments : (n_moments,) int array
        Steps after it at which Lacey's index is given.
    """

    before: Frames
    n_steps: int
    top: int
    start: Frames
    marked: NDArray[np.bool_]
    moments: NDArray[np.int64]

    def numbers(self, seed: np.random.SeedSequence, chain: MarkovChain) -> Array:
        """Times, share that has arrived at the top, and Lacey's indices, in one row; see `parted`."""
        held = np.bincount(chain.states(self.before), minlength=chain.matrix.shape[0]).astype(float)
        times = times_of(chain, held, 1 / self.before.cells.shape[1], self.top)
        share = arrived_share(chain, held, self.top, self.n_steps)
        return np.concatenate((times, [share], self.indices(seed, chain).ravel()))

    def indices(self, seed: np.random.SeedSequence, chain: Chain) -> Array:
        """Lacey's indices of as many particles as the DEM has, drawn by a chain; (2, n_moments)."""
        random = np.random.default_rng(seed)
        return lacey_indices(chain.densities(self.start, self.marked, list(self.moments), random))


def parted(numbers: Array) -> tuple[Array, Array, Array]:
    """Times (..., 4), share (...) and indices (..., 2, n_moments) of `Asked.numbers`."""
    times, share, indices = np.split(numbers, [len(TIMES), len(TIMES) + 1], axis=-1)
    n_moments = indices.shape[-1] // 2
    return times, share[..., 0], indices.reshape(*indices.shape[:-1], 2, n_moments)


def relearned(
    name: str, frames: Frames, grid: Grid, settings: ModelSettings,
    blocks: Callable[[int], BlockCounts], lag: int,
) -> Callable[[NDArray[np.bool_]], Chain]:  # fmt: skip
    """`registry.relearner` at a lag, from counts of blocks that both of the paper's models share."""
    shared = {"single": blocks(lag)} if name in PAPER_MODELS else {}
    options = settings.options.get(name, {})
    return registry.relearner(name, frames, grid, lag, settings.estimator, **shared, **options)


def moments_of(n_steps: int) -> NDArray[np.int64]:
    """Steps of the comparison window at which Lacey's index is given."""
    return np.unique(np.linspace(0, n_steps, min(n_steps, LACEY_MOMENTS) + 1).astype(np.int64))


def in_cells(times_s: np.ndarray, cells: np.ndarray, grid: Grid) -> Frames:
    """Frames in which every particle is in the middle of its cell, all that a chain of cells knows."""
    x, z = grid.centres_m.astype(np.float32).T
    return Frames(times_s, x[cells], z[cells], np.asarray(cells))


if rule := globals().get("snakemake"):
    run_stage(diagnose_chains, rule)
