# SPDX-License-Identifier: GPL-3.0-or-later
"""Diagnostics of the chains, what they imply and how far they hold: results/<case>/diagnostics.csv."""

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

from bedchain.chains import registry
from bedchain.chains.chain import Chain
from bedchain.chains.circulation import circulation
from bedchain.chains.counting import count_moves
from bedchain.chains.estimators import visited_density
from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.passage import top_row
from bedchain.chains.registry import ModelSettings
from bedchain.comparison.diagnostics import (
    arrival_row,
    dispersion_rows,
    estimator_rows,
    lacey_rows,
    table,
    time_rows,
    times_of,
)
from bedchain.comparison.forecasts import count_sides
from bedchain.comparison.markov_test import check_model, counted_rows, doubled_lags
from bedchain.comparison.metrics import Metric, metric
from bedchain.comparison.mode_maps import COLUMNS as MAP_COLUMNS
from bedchain.comparison.mode_maps import mode_maps, mode_rows
from bedchain.files import write_csv
from bedchain.measures.batch import total_variation
from bedchain.measures.mixing import Splits, marked_histogram, sides
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
    if short := shortness((len(frames.times_s) - 1) / remembered):
        LOG.warning("the learning window's %s", short)
    random = iter(np.random.default_rng(settings.seed).spawn(2 * len(chains)))
    density = visited_density(count_moves(frames.cells, run.grid.n_cells, lag))
    top = top_row(density, run.grid, TOP_SHARE)

    rows = estimator_rows(frames, run.grid, lag, list(chains))
    rows += counted_rows(looks, frames, remembered)
    before = run.up_to(learning.start_s, lag, run.grid)
    maps: list[pd.DataFrame] = []
    for name, markov in with_matrix.items():
        options = settings.options.get(name, {})
        relearner = partial(
            registry.relearner, name, frames, run.grid, estimator=settings.estimator, **options
        )
        times_there = partial(times_from, before, 1 / frames.cells.shape[1], top)
        checked, first = check_model(name, relearner, frames, looks, lags, remembered, times_there)
        numbers = (first.whole.further, first.left_out.further)
        flow = circulation(first.chain, first.modes.density)
        maps.append(mode_maps(first.chain, first.modes, flow))
        rows += mode_rows(first.chain, first.modes, flow)
        rows += checked + time_rows(name, markov.lag_s, top * run.grid.cell_height_m, *numbers)
    rows += path_rows("dem", frames, run.grid, top, lags)
    known = in_cells(frames.times_s, frames.cells, run.grid)
    rows += dispersion_rows("dem_cells", known, run.grid, lags[::DISPERSION_STRIDE])
    for name, chain in chains.items():
        if name not in PAPER_MODELS:
            distance = total_variation(chain.long_run_density(before), density)
            rows.append(
                metric("long_run_total_variation", name, distance, lag_s=chain.lag_s, part=settings.estimator)
            )
        times = frames.times_s[::lag]
        paths = np.array([now.copy() for now in chain.paths(before, len(times) - 1, next(random))])
        steps = [one // lag for one in lags]
        rows += path_rows(name, in_cells(times, paths, run.grid), run.grid, top, steps)
    start = run.up_to(comparison.start_s, lag, run.grid)
    compared = run.window(comparison)
    rows += index_rows(chains, start, compared, splits, lag, random)
    write_csv(table(rows), diagnostics)
    write_csv(pd.concat(maps) if maps else pd.DataFrame(columns=list(MAP_COLUMNS)), modes)
    for one in rows:
        if one["quantity"] in REPORTED and one["lag_s"] == lag * frames.interval_s:
            what = f"{one['source']} {one.get('part', '')} {one['quantity']}"
            LOG.info("%s: %.4g %s", what, one["value"], one["unit"])


def times_from(start: Frames, least_share: float, top: int, chain: MarkovChain) -> Array:
    """`times_of` a chain that starts from the last of some frames."""
    held = np.bincount(chain.states(start), minlength=chain.matrix.shape[0])
    return times_of(chain, held.astype(float), least_share, top)


def path_rows(source: str, frames: Frames, grid: Grid, top: int, lags: Sequence[int]) -> list[Metric]:
    """Arrivals at the top and dispersion coefficients of particles followed from frame to frame."""
    rows = [arrival_row(source, frames, grid, top)] if grid.rows_are_heights else []
    return rows + dispersion_rows(source, frames, grid, lags[::DISPERSION_STRIDE])


def in_cells(times_s: np.ndarray, cells: np.ndarray, grid: Grid) -> Frames:
    """Frames in which every particle is in the middle of its cell, all that a chain of cells knows."""
    x, z = grid.centres_m.astype(np.float32).T
    return Frames(times_s, x[cells], z[cells], np.asarray(cells))


def index_rows(
    chains: dict[str, Chain], start: Frames, window: Frames, splits: Splits, lag: int,
    random: Iterator[np.random.Generator],
) -> list[Metric]:  # fmt: skip
    """Lacey's index over the comparison window, by the DEM and by as many particles of each chain.

    Parameters
    ----------
    chains : dict of str to Chain
    start : Frames
        Up to the start of the comparison, of the particles that are there then.
    window : Frames
        The comparison window.
    splits : Splits
    lag : int
        Frames in a step of the chains.
    random : iterator of numpy Generator
        One for each chain.

    Returns
    -------
    list of dict
    """
    there = np.asarray(window.cells[0]) != OUTSIDE
    marked = sides(np.asarray(window.x_m[0]), np.asarray(window.z_m[0]), *splits) & there
    first = next(iter(chains.values()))
    n_steps = (len(window.times_s) - 1) // lag
    steps = np.unique(np.linspace(0, n_steps, min(n_steps, LACEY_MOMENTS) + 1).astype(int))
    times = steps * first.lag_s
    seen = [marked_histogram(window.cells[step * lag], marked, first.grid.n_cells) for step in steps]
    rows = lacey_rows("dem", times, np.array(seen))
    for name, chain in chains.items():
        rows += lacey_rows(name, times, chain.densities(start, marked[:, there], list(steps), next(random)))
    return rows


if rule := globals().get("snakemake"):
    run_stage(diagnose_chains, rule)
