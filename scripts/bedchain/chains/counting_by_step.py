# SPDX-License-Identifier: GPL-3.0-or-later
"""Transition counts of each step apart: counts of any selection of steps in milliseconds, for error bars."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains.counting import Counts, count_moves


@dataclass(frozen=True)
class StepCounts:
    """Moves from cell to cell of each step of a window.

    Parameters
    ----------
    moves : (n_steps, n_entries) int64 csr_array
        N_ij of each step, by the entry (i, j) [1].
    shares : (n_steps, n_entries) float64 csr_array
        N_ij / N_i of each step [1].
    occupied : (n_steps, n_cells) int64 csr_array
        1 where a cell held a particle at the start of the step.
    indices : (n_entries,) int32 array
        The cell j of each entry.
    indptr : (n_cells + 1,) int32 array
        Where the entries of each cell i begin.
    lag : int
        Frames in a step.
    """

    moves: sparse.csr_array
    shares: sparse.csr_array
    occupied: sparse.csr_array
    indices: NDArray[np.int32]
    indptr: NDArray[np.int32]
    lag: int

    def weighted(self, weights: NDArray[np.int64]) -> Counts:
        """Counts of weighted steps, as `counting.count_moves` with ``step_weights``.

        Parameters
        ----------
        weights : (n_steps,) int array
            How many times each step counts [1].

        Returns
        -------
        Counts
            Without the moves that occur in no chosen step.
        """
        n_cells = self.indptr.size - 1
        total = weights @ self.moves
        counted = total > 0
        before = np.concatenate(([0], np.cumsum(counted)))
        index = (self.indices[counted], before[self.indptr].astype(np.int32))
        moves = sparse.csr_array((total[counted], *index), shape=(n_cells, n_cells))
        shares = sparse.csr_array(((weights @ self.shares)[counted], *index), shape=(n_cells, n_cells))
        return Counts(moves, shares, weights @ self.occupied, int(weights.sum()), self.lag)


def count_steps(cells: NDArray[np.int32], n_cells: int, lag: int = 1) -> StepCounts:
    """Count the moves of every step apart; takes about 16 bytes for each distinct move of a step.

    Parameters
    ----------
    cells : (n_frames, n_particles) int array
        Cell of each particle.
    n_cells : int
        Number of cells of the grid.
    lag : int
        Frames in a step.

    Returns
    -------
    StepCounts
        Of ``n_frames - lag`` steps.
    """
    n_steps = max(len(cells) - lag, 1)  # count_moves refuses too few frames
    steps = [count_moves(cells, n_cells, lag, first=step, last=step + 1) for step in range(n_steps)]
    keys = [_keys(step.moves) for step in steps]
    entries = np.unique(np.concatenate(keys))
    columns = np.concatenate([np.searchsorted(entries, part) for part in keys]).astype(np.int32)
    ends = np.concatenate(([0], np.cumsum([part.size for part in keys])))
    moves, shares = (
        sparse.csr_array(
            (np.concatenate([getattr(step, name).data for step in steps]), columns, ends),
            shape=(n_steps, entries.size),
        )
        for name in ("moves", "shares")
    )
    indptr = np.concatenate(([0], np.cumsum(np.bincount(entries // n_cells, minlength=n_cells))))
    occupied = sparse.csr_array(np.stack([step.occupied for step in steps]))
    indices = (entries % n_cells).astype(np.int32)
    return StepCounts(moves, shares, occupied, indices, indptr.astype(np.int32), lag)


def _keys(moves: sparse.csr_array) -> NDArray[np.int64]:
    """Entries of a matrix as rising numbers ``row * n_columns + column``."""
    rows = np.repeat(np.arange(moves.shape[0], dtype=np.int64), np.diff(moves.indptr))
    return rows * moves.shape[1] + moves.indices
