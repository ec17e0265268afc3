# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain run over the comparison window, exactly and by Monte Carlo: results/<case>/chain_<model>.npz."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from bedchain.chains import registry
from bedchain.errors import UserError
from bedchain.files import write_arrays
from bedchain.measures.batch import batch_of
from bedchain.measures.mixing import GROUPS
from bedchain.stage import LOG, stage
from bedchain.trajectory.cell_store import frame_at
from bedchain.trajectory.frames import lag_frames, whole_steps, window
from bedchain.trajectory.realisations import open_realisation
from bedchain.uncertainty.bands import block_chains, block_length

# a moment lies on a step up to round-off of the division
STEP_TOLERANCE = 1e-6
# chains that are learned again for the error bars
REPLICATES = 40


def run_chain(
    trajectory: Path, metadata: Path, cells: Path, transitions: Path, chain: Path,
    learning: dict[str, float], estimator: str,
    start_s: float, end_s: float, split_x_m: float, split_z_m: float,
    batch_height_m: float, moments_s: list[float], seed: int, options: dict[str, Any] | None = None,
) -> None:  # fmt: skip
    """Advance the marked groups of Fig. 5 and the batch of Figs. 3 and 4, by expectation and by dice.

    Parameters
    ----------
    trajectory, metadata, cells, transitions : Path
        ``trajectory.npy``, ``trajectory.json``, ``cells.npz``, ``transitions_<model>.npz``.
    chain : Path
        Gets times_s, groups, remaining and remaining_monte_carlo (n_times, 4), remaining_replicates
        (n, n_times, 4) of chains learned again on blocks of the learning window, moments_s, batch_share and
        batch_share_monte_carlo (n_moments, n_cells), lag_s, report (of learning, json).
    learning : dict of str to float
        ``start_s`` and ``end_s`` of the learning window [s].
    estimator : {"literal", "per_step", "pooled"}
        How counts become probabilities.
    start_s, end_s : float
        The comparison window [s].
    split_x_m, split_z_m : float
        Lines between left and right, low and up [m].
    batch_height_m : float
        The batch is what is in the rows of cells below this height at the start [m].
    moments_s : list of float
        Times after the start at which the batch is wanted [s].
    seed : int
        Of the Monte Carlo runs.
    options : dict, optional
        Settings of this model only, as it was learned with.

    Raises
    ------
    DataError, UserError
        The window or a moment is no whole number of steps.
    """
    bed, model = open_realisation("the run", trajectory, metadata, cells), registry.load(transitions)
    lag = lag_frames(model.lag_s, float(np.diff(bed.times_s).mean()))
    which = window(bed.times_s, start_s, end_s)
    steps = whole_steps(which.stop - which.start, lag)
    start = bed.up_to(start_s, lag)
    batch = batch_of(bed.grid, np.asarray(start.cells[-1]), batch_height_m)[None]
    at = moment_steps(moments_s, model.lag_s)
    for_mixing, for_batch, for_blocks = np.random.default_rng(seed).spawn(3)
    learned_from = bed.window(learning["start_s"], learning["end_s"])
    splits = (split_x_m, split_z_m)
    write_arrays(
        chain,
        {
            "times_s": bed.times_s[frame_at(bed.times_s, start_s)] + model.lag_s * np.arange(steps + 1),
            "groups": np.array([group for _, group in GROUPS]),
            "remaining": model.mixing(start, *splits, steps),
            "remaining_monte_carlo": model.mixing(start, *splits, steps, for_mixing),
            "remaining_replicates": block_chains(
                registry.relearner(model.name, learned_from, bed.grid, lag, estimator, **(options or {})),
                lambda again: again.mixing(start, *splits, steps),
                len(learned_from.times_s) - lag,
                block_length(learned_from, split_x_m, lag),
                REPLICATES,
                for_blocks,
            ),
            "moments_s": np.array(moments_s, float),
            "batch_share": model.densities(start, batch, at)[:, 0] / batch.sum(),
            "batch_share_monte_carlo": model.densities(start, batch, at, for_batch)[:, 0] / batch.sum(),
            "lag_s": np.array(model.lag_s),
            "report": np.array(json.dumps(model.report)),
        },
    )
    LOG.info(
        "%s chain: %d steps of %g s, a batch of %d particles", model.name, steps, model.lag_s, batch.sum()
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


if "snakemake" in globals():
    with stage(snakemake.log[0]):
        run_chain(
            Path(snakemake.input.trajectory),
            Path(snakemake.input.metadata),
            Path(snakemake.input.cells),
            Path(snakemake.input.transitions),
            Path(snakemake.output.chain),
            snakemake.params.learning,
            snakemake.params.estimator,
            snakemake.params.start_s,
            snakemake.params.end_s,
            snakemake.params.split_x_m,
            snakemake.params.split_z_m,
            snakemake.params.batch_height_m,
            snakemake.params.moments_s,
            snakemake.params.seed,
            snakemake.params.options,
        )
