# SPDX-License-Identifier: GPL-3.0-or-later
"""Shares of the groups a fraction of a step later, straight from the moves: P_f @ shares without P_f.

Mixing curves between two steps (`between_steps`) need of a matrix P_f only its product with the share of each
cell on either side. That is a mean over the particles of a cell, counted here without the matrix, for several
sets of weights at once, such as a window without each of its blocks.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from bedchain.chains.counting import step_starts
from bedchain.chains.estimators import ESTIMATORS
from bedchain.errors import DataError
from bedchain.trajectory.chunks import chunks
from bedchain.trajectory.frames import Frames

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ShareFractions:
    """Shares on each side a fraction of a step later.

    Parameters
    ----------
    by_frames : (lag - 1, n_groups, n_cells) array
        Of the particles of each cell, 1, 2, ... frames later [1].
    """

    by_frames: Array

    @property
    def lag(self) -> int:
        """Frames in a step."""
        return len(self.by_frames) + 1

    def later(self, frames: int, shares: Array) -> Array:
        """Shares after so many frames, (n_groups, n_cells); ``shares`` are those that were counted."""
        return np.asarray(self.by_frames[frames - 1])


def learn_share_fractions(
    frames: Frames, shares: Array, lag: int, estimator: str = "pooled",
    weights: Callable[[int], NDArray[np.int64]] | None = None,
) -> list[ShareFractions]:  # fmt: skip
    """Shares of the groups for all lags shorter than a step, for each set of weights.

    A matrix that is applied once needs no opening of closed classes; all else is as in
    `estimators.transition_matrix`: a cell never left keeps its own shares, and so does what `literal` lacks.

    Parameters
    ----------
    frames : Frames
        The learning window.
    shares : (n_groups, n_cells) array
        Share of each cell on each side; groups come in pairs whose shares sum to 1
        (`measures.mixing.side_shares`).
    lag : int
        Frames in a step.
    estimator : {"literal", "per_step", "pooled"}
        How counts become probabilities.
    weights : callable, optional
        From a lag to how many times the step of that lag from each frame counts in each set,
        (n_sets, n_frames - lag); a single set of ones by default.

    Returns
    -------
    list of ShareFractions
        One for each set.

    Raises
    ------
    DataError
        The estimator is unknown; a cell number is outside the grid.
    """
    if estimator not in ESTIMATORS:
        raise DataError(f"estimator {estimator!r} is unknown: choose one of {', '.join(ESTIMATORS)}")
    cells, later = np.asarray(frames.cells), []
    for shorter in range(1, lag):
        number = np.ones((1, len(cells) - shorter)) if weights is None else weights(shorter)
        later.append(_later(cells, shares, shorter, estimator, np.asarray(number, np.float64)))
    if not later:
        sets = 1 if weights is None else len(weights(1))
        return [ShareFractions(np.zeros((0, *shares.shape)))] * sets
    return [ShareFractions(np.ascontiguousarray(of_set)) for of_set in np.stack(later, axis=1)]


def _later(cells: NDArray[np.int32], shares: Array, lag: int, estimator: str, weights: Array) -> Array:
    """Shares after a lag by set, (n_sets, n_groups, n_cells)."""
    firsts = np.ascontiguousarray(shares[::2].T)
    n_cells, n_pairs = firsts.shape
    sums, number = np.zeros((len(weights), n_cells, n_pairs)), np.zeros((len(weights), n_cells))
    starts, once = step_starts(cells, lag, 1, 0, None, None)
    for (before, after), used in chunks(cells, n_cells, starts, np.cumsum(once) - 1, (0, lag)):
        _add_steps(before, after, weights[:, used], firsts, estimator == "pooled", sums, number)
    whole = weights.sum(axis=1)[:, None] if estimator == "literal" else number
    kept = np.where(whole > 0, 1 - number / np.where(whole > 0, whole, 1), 1)
    mean = sums / np.where(whole > 0, whole, 1)[:, :, None] + kept[:, :, None] * firsts
    later = np.empty((len(weights), *shares.shape))
    later[:, ::2] = mean.transpose(0, 2, 1)
    later[:, 1::2] = 1 - later[:, ::2]
    return later


@njit(cache=True)
def _add_steps(before, after, weights, values, pooled, sums, number):  # type: ignore[no-untyped-def]
    """Add the values of the cells moved to, by the cell left, of all steps to each set."""
    n_cells, n_values = values.shape
    of_step, visits = np.empty((n_cells, n_values)), np.empty(n_cells)
    for step in range(before.shape[0]):
        of_step[:] = 0.0
        visits[:] = 0.0
        for particle in range(before.shape[1]):
            i, j = before[step, particle], after[step, particle]
            if i >= 0 and j >= 0:  # a particle that is not there has no cell
                visits[i] += 1.0
                for value in range(n_values):
                    of_step[i, value] += values[j, value]
        for s in range(weights.shape[0]):
            weight = weights[s, step]
            if weight == 0.0:
                continue
            for i in range(n_cells):
                if visits[i] > 0.0:
                    part = weight if pooled else weight / visits[i]
                    number[s, i] += part * visits[i]
                    for value in range(n_values):
                        sums[s, i, value] += part * of_step[i, value]
