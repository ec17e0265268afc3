# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain run over the comparison window, exactly and by Monte Carlo: results/<case>/chain_<model>.npz."""

import json
from pathlib import Path

import numpy as np

from bedchain.chains import registry
from bedchain.chains.registry import ModelSettings
from bedchain.errors import UserError
from bedchain.files import write_arrays
from bedchain.measures.batch import Batch, batch_of
from bedchain.measures.mixing import GROUPS, Splits
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.cell_store import frame_at
from bedchain.trajectory.frames import Window, lag_frames, whole_steps
from bedchain.trajectory.realisations import open_bed
from bedchain.trajectory.store import BedFiles
from bedchain.uncertainty.bands import block_chains, block_length

# a moment lies on a step up to round-off of the division
STEP_TOLERANCE = 1e-6
# chains that are learned again for the error bars
REPLICATES = 40


def run_chain(
    bed: BedFiles, transitions: Path, chain: Path,
    learning: Window, comparison: Window, splits: Splits, batch: Batch, settings: ModelSettings,
) -> None:  # fmt: skip
    """Advance the marked groups of Fig. 5 and the batch of Figs. 3 and 4, by expectation and by Monte Carlo.

    Parameters
    ----------
    bed : BedFiles
    transitions : Path
        ``transitions_<model>.npz``.
    chain : Path
        Gets times_s, groups, remaining and remaining_monte_carlo (n_times, 4), remaining_replicates
        (n, n_times, 4) of chains learned again on blocks of the learning window, moments_s, batch_share and
        batch_share_monte_carlo (n_moments, n_cells), lag_s, report (of learning, json).
    learning, comparison : Window
    splits : Splits
    batch : Batch
    settings : ModelSettings
        Those that the chain was learned with.

    Raises
    ------
    DataError, UserError
        The window or a moment is no whole number of steps.
    """
    run, model = open_bed(bed), registry.load(transitions)
    lag = lag_frames(model.lag_s, float(np.diff(run.times_s).mean()))
    which = comparison.frames(run.times_s)
    steps = whole_steps(which.stop - which.start, lag)
    start = run.up_to(comparison.start_s, lag)
    marked = batch_of(run.grid, np.asarray(start.cells[-1]), batch.batch_height_m)[None]
    at = moment_steps(batch.moments_s, model.lag_s)
    for_mixing, for_batch, for_blocks = np.random.default_rng(settings.seed).spawn(3)
    learned_from = run.window(learning)
    write_arrays(
        chain,
        {
            "times_s": run.times_s[frame_at(run.times_s, comparison.start_s)]
            + model.lag_s * np.arange(steps + 1),
            "groups": np.array([group for _, group in GROUPS]),
            "remaining": model.mixing(start, *splits, steps),
            "remaining_monte_carlo": model.mixing(start, *splits, steps, for_mixing),
            "remaining_replicates": block_chains(
                registry.relearner(
                    model.name, learned_from, run.grid, lag, settings.estimator, **settings.options
                ),
                lambda again: again.mixing(start, *splits, steps),
                len(learned_from.times_s) - lag,
                block_length(learned_from, splits.split_x_m, lag),
                REPLICATES,
                for_blocks,
            ),
            "moments_s": np.array(batch.moments_s, float),
            "batch_share": model.densities(start, marked, at)[:, 0] / marked.sum(),
            "batch_share_monte_carlo": model.densities(start, marked, at, for_batch)[:, 0] / marked.sum(),
            "lag_s": np.array(model.lag_s),
            "report": np.array(json.dumps(model.report)),
        },
    )
    LOG.info(
        "%s chain: %d steps of %g s, a batch of %d particles", model.name, steps, model.lag_s, marked.sum()
    )


def moment_steps(moments_s: list[float], lag_s: float) -> list[int]:
    """Steps of the chain at which moments lie.

    Parameters
    ----------
    moments_s : list of float
        Rising times after the start [s].
    lag_s : float
        Time of a step [s].

    Returns
    -------
    list of int

    Raises
    ------
    UserError
        A moment is no multiple of the lag, or they do not rise.
    """
    steps = [round(moment / lag_s) for moment in moments_s]
    for moment, step in zip(moments_s, steps, strict=True):
        if abs(moment / lag_s - step) > STEP_TOLERANCE * max(step, 1):
            raise UserError(f"figures.moments_s: {moment:g} s is no multiple of chain.lag_s, {lag_s:g} s")
    if steps != sorted(set(steps)):
        raise UserError(f"figures.moments_s: {moments_s} must rise")
    return steps


if rule := globals().get("snakemake"):
    run_stage(run_chain, rule)
