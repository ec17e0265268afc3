# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain run over the comparison window, exactly and by Monte Carlo: results/<case>/chain_<model>.npz."""

import json
from pathlib import Path

import numpy as np

from bedchain.chains import registry
from bedchain.chains.between_steps import densities_at, mixing_by_frame
from bedchain.chains.chain import Chain
from bedchain.chains.registry import ModelSettings
from bedchain.errors import UserError, make_again
from bedchain.files import write_arrays
from bedchain.measures.batch import Batch, batch_of
from bedchain.measures.mixing import GROUPS, Splits
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.frames import Window, lag_frames
from bedchain.trajectory.realisations import open_bed
from bedchain.trajectory.regrid import regrid
from bedchain.trajectory.store import BedFiles
from bedchain.uncertainty.bands import block_chains, block_length

# a moment lies on a frame up to round-off of the division
FRAME_TOLERANCE = 1e-6
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
        A moment is between frames, or the chain's file lacks its fractions of a step.
    """
    run, model = open_bed(bed), registry.load(transitions)
    lag, fractions = lag_frames(model.lag_s, run.interval_s), registry.load_fractions(transitions)
    if fractions.lag != lag:
        raise UserError(f"{transitions} answers at whole steps only; {make_again(transitions)}")
    which = comparison.frames(run.times_s)
    length = which.stop - 1 - which.start
    start = run.leading_to(model.grid, which.start, lag)
    in_cells = run.leading_to(run.grid, which.start, lag, 0).cells[-1]
    marked = batch_of(run.grid, np.asarray(in_cells), batch.batch_height_m)[None]
    at = moment_frames(batch.moments_s, run.interval_s)
    for_mixing, for_batch, for_blocks = np.random.default_rng(settings.seed).spawn(3)
    learned_from = run.frames(model.grid, learning.frames(run.times_s))

    def curves(of: Chain, rng: np.random.Generator | None = None) -> np.ndarray:
        return mixing_by_frame(of, fractions, start, splits, length, rng)

    def shares(rng: np.random.Generator | None = None) -> np.ndarray:
        numbers = densities_at(model, fractions, start, marked, at, rng)[:, 0]
        own = model.grid == run.grid
        return (numbers if own else regrid(numbers, model.grid, run.grid)) / marked.sum()

    write_arrays(
        chain,
        {
            "times_s": run.times_s[which],
            "groups": np.array([group for _, group in GROUPS]),
            "remaining": curves(model),
            "remaining_monte_carlo": curves(model, for_mixing),
            "remaining_replicates": block_chains(
                registry.relearner(
                    model.name, learned_from, model.grid, lag, settings.estimator, **settings.options
                ),
                curves,
                len(learned_from.times_s) - lag,
                block_length(learned_from, splits.split_x_m, lag),
                REPLICATES,
                for_blocks,
            ),
            "moments_s": np.array(batch.moments_s, float),
            "batch_share": shares(),
            "batch_share_monte_carlo": shares(for_batch),
            "lag_s": np.array(model.lag_s),
            "report": np.array(json.dumps(model.report)),
        },
    )
    LOG.info("%s chain: %d frames, steps of %g s, a batch of %d particles", model.name, length, model.lag_s,
             marked.sum())  # fmt: skip


def moment_frames(moments_s: list[float], interval_s: float) -> list[int]:
    """Frames after the start at which moments lie.

    Parameters
    ----------
    moments_s : list of float
        Rising times after the start [s].
    interval_s : float
        Between two frames [s].

    Returns
    -------
    list of int

    Raises
    ------
    UserError
        A moment is no multiple of the interval, or they do not rise.
    """
    frames = [round(moment / interval_s) for moment in moments_s]
    for moment, frame in zip(moments_s, frames, strict=True):
        if abs(moment / interval_s - frame) > FRAME_TOLERANCE * max(frame, 1):
            raise UserError(f"figures.moments_s: {moment:g} s is no multiple of the frames' {interval_s:g} s")
    if frames != sorted(set(frames)):
        raise UserError(f"figures.moments_s: {moments_s} must rise")
    return frames


if rule := globals().get("snakemake"):
    run_stage(run_chain, rule)
