# SPDX-License-Identifier: GPL-3.0-or-later
"""Validation by five folds: chains learned without each block of the learning window, judged on it."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from bedchain.chains.chain import Chain
from bedchain.chains.fraction_shares import ShareFractions, learn_share_fractions
from bedchain.measures.mixing import side_shares
from bedchain.studies.candidates import Candidate, grid_of
from bedchain.studies.marked_starts import Start, blocks_of, starts_in, steps_outside
from bedchain.studies.scan import Task, learned, observed_curves, predicted_curves
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.realisations import Realisation
from bedchain.uncertainty.bands import block_band

Array = NDArray[np.float64]


def starts_by_fold(learning: slice, lag: int, spacing: int) -> list[list[Start]]:
    """Starts in each block of the learning window, each followed to the end of its block.

    Parameters
    ----------
    learning : slice
        Frames of the window.
    lag : int
        Of the chain, which may look back two of them [frames].
    spacing : int
        Least number of frames between starts.

    Returns
    -------
    list of list of Start
    """
    return [starts_in(_with_past(block, lag), spacing) for block in blocks_of(learning)]


def squared_errors(
    candidate: Candidate, run: Realisation, frames: Frames, learning: slice, task: Task
) -> list[Array]:
    """Squared errors of the curves in each block, of the chain learned without it.

    Parameters
    ----------
    candidate : Candidate
    run : Realisation
        With frames up to the end of the learning window at least.
    frames : Frames
        The learning window on the candidate's grid.
    learning : slice
        Its frames in the run.
    task : Task

    Returns
    -------
    list of (n_times, 4) array
        Of all starts of each block, one below the other [1].

    Raises
    ------
    DataError
        The window is too short for the lag, or the model cannot use the data.
    """
    lag, blocks = candidate.lag, blocks_of(learning)
    reach = 2 * lag if candidate.model == "dynamic" else lag
    shares = side_shares(grid_of(candidate, task.grid), *task.splits)
    fractions = learn_share_fractions(
        frames, shares, lag, task.estimator,
        lambda shorter: np.stack([steps_outside(block, learning, shorter) for block in blocks]),
    )  # fmt: skip
    starts, squares = starts_by_fold(learning, lag, task.spacing), []
    for block, of_block, between in zip(blocks, starts, fractions, strict=True):
        weights = np.pad(steps_outside(block, learning, reach), (0, reach - lag))
        chain = learned(candidate, frames, task, weights)
        squares.append(_squares(chain, between, run, of_block, task))
    return squares


def over_folds(squares: Sequence[Array]) -> tuple[float, float, float]:
    """Rms over all folds, and the ends of its 95 % band from leaving each fold out."""
    error = np.sqrt(np.nanmean(np.concatenate(squares)))
    left_out = [
        np.sqrt(np.nanmean(np.concatenate([*squares[:fold], *squares[fold + 1 :]])))
        for fold in range(len(squares))
    ]
    low, high = block_band(error, np.array(left_out))
    return float(error), max(0.0, float(low)), float(high)


def _with_past(block: slice, lag: int) -> slice:
    """A block less the frames from which a chain that looks back two lags cannot start."""
    first = min(2 * lag, block.stop - 1 - lag)
    return slice(max(block.start, first), block.stop)


def _squares(
    chain: Chain, fractions: ShareFractions, run: Realisation, starts: Sequence[Start], task: Task
) -> Array:
    """Squared errors of the curves from all starts in a block, (n_times, 4)."""
    errors = [
        predicted_curves(chain, run, start, fractions.lag, task.splits, fractions)[1:]
        - observed_curves(run, start, task.splits)[1:]
        for start in starts
    ]
    return np.concatenate(errors) ** 2
