# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain run over the comparison window, exactly and by Monte Carlo: results/<case>/chain_<model>.npz."""

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from bedchain.chains import registry
from bedchain.chains.between_steps import Fractions, densities_at, fractions_relearner, mixing_by_frame
from bedchain.chains.chain import Chain
from bedchain.chains.registry import ModelSettings
from bedchain.errors import UserError, make_again
from bedchain.files import write_arrays
from bedchain.measures.batch import Batch, batch_of
from bedchain.measures.mixing import GROUPS, Splits
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.frames import Frames, Window, lag_frames
from bedchain.trajectory.realisations import open_bed
from bedchain.trajectory.regrid import regrid
from bedchain.trajectory.store import BedFiles
from bedchain.uncertainty.bands import correlation_times, kept_blocks, shortness

# a moment lies on a frame up to round-off of the division
FRAME_TOLERANCE = 1e-6


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
        Gets times_s, groups, remaining and remaining_monte_carlo (n_times, 4), moments_s, batch_share and
        batch_share_monte_carlo (n_moments, n_cells), lag_s, report (of learning, json); and for the bands
        remaining_left_out (BLOCKS, n_times, 4) and batch_share_left_out (BLOCKS, n_moments, n_cells) of
        chains learned without each block of the learning window, none if it is too short.
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
    start = run.leading_to(model.grid, which.start, lag).seen_last()
    in_cells = run.leading_to(run.grid, which.start, lag, 0).seen_last().cells[-1]
    marked = batch_of(run.grid, np.asarray(in_cells), batch.batch_height_m)[None]
    at = moment_frames(batch.moments_s, run.interval_s)
    for_mixing, for_batch = np.random.default_rng(settings.seed).spawn(2)
    learned_from = run.frames(model.grid, learning.frames(run.times_s))

    def curves(of: Chain, parts: Fractions, rng: np.random.Generator | None = None) -> np.ndarray:
        return mixing_by_frame(of, parts, start, splits, length, rng)

    def shares(of: Chain, parts: Fractions, rng: np.random.Generator | None = None) -> np.ndarray:
        numbers = densities_at(of, parts, start, marked, at, rng)[:, 0]
        own = model.grid == run.grid
        return (numbers if own else regrid(numbers, model.grid, run.grid)) / marked.sum()

    without: tuple[list[np.ndarray], list[np.ndarray]] = ([], [])
    for of_kept in left_out(
        learned_from, correlation_times(learned_from, splits.split_x_m, lag), model, settings
    ):
        without[0].append(curves(*of_kept))
        without[1].append(shares(*of_kept))
    write_arrays(
        chain,
        {
            "times_s": run.times_s[which],
            "groups": np.array([group for _, group in GROUPS]),
            "remaining": curves(model, fractions),
            "remaining_monte_carlo": curves(model, fractions, for_mixing),
            "remaining_left_out": np.reshape(without[0], (-1, length + 1, len(GROUPS))),
            "moments_s": np.array(batch.moments_s, float),
            "batch_share": shares(model, fractions),
            "batch_share_monte_carlo": shares(model, fractions, for_batch),
            "batch_share_left_out": np.reshape(without[1], (-1, len(at), run.grid.n_cells)),
            "lag_s": np.array(model.lag_s),
            "report": np.array(json.dumps(model.report)),
        },
    )
    LOG.info("%s chain: %d frames, steps of %g s, a batch of %d particles", model.name, length, model.lag_s,
             marked.sum())  # fmt: skip


def left_out(
    frames: Frames, times: float, model: Chain, settings: ModelSettings
) -> Iterator[tuple[Chain, Fractions]]:
    """A model without each block of a window of so many correlation times, none if the window is too short.

    Its fractions of a step are learned without the block too: else the band has no width in the first step.
    """
    if short := shortness(times):
        LOG.warning("the learning window's %s", short)
        return
    lag = lag_frames(model.lag_s, frames.interval_s)
    relearn = registry.relearner(model.name, frames, model.grid, lag, settings.estimator, **settings.options)
    of_step = fractions_relearner(frames, model.grid.n_cells, lag, settings.estimator)
    for kept in kept_blocks():
        yield relearn(kept), of_step(kept)


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
