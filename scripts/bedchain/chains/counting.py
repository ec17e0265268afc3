# SPDX-License-Identifier: GPL-3.0-or-later
"""Transition counts between cells, in one pass over the frames."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains import sorted_counts
from bedchain.chains.dense_counts import MOST_PAIRS, MoveTable
from bedchain.errors import DataError
from bedchain.trajectory.chunks import chunks


@dataclass(frozen=True)
class Counts:
    """Moves counted over some steps.

    Parameters
    ----------
    moves : (n_from, n_cells) int64 csr_array
        N_ij summed over the steps: particles in i that are in j one lag later [1].
    shares : (n_from, n_cells) float64 csr_array
        Sum over the steps of N_ij / N_i, on the same entries [1].
    occupied : (n_from,) int64 array
        Steps in which i held a particle [1].
    steps : int
        Steps counted [1].
    lag : int
        Frames in a step [1].
    pairs : (n_from, 2) int64 array or None
        For counts of pairs: the previous and the present cell of each row, rising; else None.
    lost, inserted : (n_cells,) int64 array or None
        Particles in each cell that are not there one lag later, or were not there one lag before, summed over
        the steps [1]; they are in no other number. None where all are always there, and for pairs.
    """

    moves: sparse.csr_array
    shares: sparse.csr_array
    occupied: NDArray[np.int64]
    steps: int
    lag: int
    pairs: NDArray[np.int64] | None = None
    lost: NDArray[np.int64] | None = None
    inserted: NDArray[np.int64] | None = None

    @property
    def visits(self) -> NDArray[np.int64]:
        """Particles in each cell (or pair) at the start of a step, summed over the steps, (n_from,)."""
        return np.asarray(self.moves.sum(axis=1)).ravel()

    @property
    def n_cells(self) -> int:
        """Number of cells of the grid [1]."""
        return int(self.moves.shape[1])


def count_moves(
    cells: NDArray[np.int32],
    n_cells: int,
    lag: int = 1,
    first: int = 0,
    last: int | None = None,
    step_weights: NDArray[np.int64] | None = None,
) -> Counts:
    """Count the moves from cell to cell (Zhuang et al. 2015, Eq. 1: N_ij and N_i), both ends seen.

    Parameters
    ----------
    cells : (n_frames, n_particles) int array
        Cell of each particle; memory maps are read in chunks.
    n_cells : int
        Number of cells of the grid.
    lag : int
        Frames in a step; a step starts at every frame.
    first, last : int
        Steps starting at frames ``first <= t < last`` are counted (default: all). Counts of
        ranges that do not overlap add up to those of the whole.
    step_weights : (n_frames - lag,) int array, optional
        How many times the step starting at each frame counts (bootstrap); 1 by default.

    Returns
    -------
    Counts
        With ``moves`` of shape (n_cells, n_cells).

    Raises
    ------
    DataError
        No step fits, or a cell number is outside the grid.
    """
    starts, weights = step_starts(cells, lag, 1, first, last, step_weights)
    # one state more, for particles that are not there
    n_states, gone = n_cells + 1, np.zeros((2, n_cells), np.int64)
    table = MoveTable(n_states) if n_states**2 <= MOST_PAIRS else sorted_counts.SortedMoves(n_states)
    for parts, chunk_weights in chunks(cells, n_cells, starts, weights, (0, lag)):
        seen = _set_apart(parts, n_cells)
        if seen is not parts:
            gone += lost_and_inserted(parts[0], parts[1], chunk_weights, n_cells)
        table.add(seen[0], seen[1], chunk_weights)
    rows, columns, values = table.entries()
    inside = (rows < n_cells) & (columns < n_cells)
    begins = np.concatenate(([0], np.cumsum(np.bincount(rows[inside], minlength=n_cells))))
    moves, shares = _csr(begins, columns[inside], values[inside], n_cells)
    lost, inserted = gone if gone.any() else (None, None)
    occupied, steps = table.occupied[:n_cells], int(weights.sum())
    return Counts(moves, shares, occupied, steps, lag, lost=lost, inserted=inserted)


def count_pairs(
    cells: NDArray[np.int32],
    n_cells: int,
    lag: int = 1,
    step_weights: NDArray[np.int64] | None = None,
    first: int = 0,
    last: int | None = None,
) -> Counts:
    """Count the moves to k of particles now in j that were in i one lag ago (Zhuang et al. 2015, Eq. 2).

    Arguments as `count_moves`. A step starts at the frame of i: there are ``n_frames - 2 * lag``.

    Returns
    -------
    Counts
        One row for each pair (i, j) that occurs, in the order of ``pairs``: by rising i, then j.

    Raises
    ------
    DataError
        As `count_moves`.
    """
    starts, weights = step_starts(cells, lag, 2, first, last, step_weights)
    bits, entries = sorted_counts.cell_bits(n_cells + 1), sorted_counts.NO_ENTRIES
    for parts, chunk_weights in chunks(cells, n_cells, starts, weights, (0, lag, 2 * lag)):
        counted = sorted_counts.counted_paths(_set_apart(parts, n_cells), chunk_weights, bits)
        entries = sorted_counts.merged(entries, counted)
    keys, values = entries
    field = (1 << bits) - 1
    seen = keys & field < n_cells  # a particle that is not there is so in all three cells
    keys, values = (keys, values) if seen.all() else (keys[seen], values[seen])
    begins = np.flatnonzero(np.diff(keys >> bits, prepend=-1))
    pairs = np.column_stack((keys[begins] >> 2 * bits, keys[begins] >> bits & field))
    occupied = (
        np.add.reduceat(values[:, 2], begins).astype(np.int64) if begins.size else np.zeros(0, np.int64)
    )
    rows = np.append(begins, keys.size)
    moves, shares = _csr(rows, keys & field, values, n_cells)
    return Counts(moves, shares, occupied, int(weights.sum()), lag, pairs)


def lost_and_inserted(
    before: NDArray[np.int32], after: NDArray[np.int32], weights: NDArray[np.int64], n_cells: int
) -> NDArray[np.int64]:
    """Particles by cell that are not there at the end, and at the start, of some steps, (2, n_cells) [1].

    Parameters
    ----------
    before, after : (n_steps, n_particles) int array
        Cells at the start and the end of each step; `grid.OUTSIDE` for particles that are not there.
    weights : (n_steps,) int64 array
        How many times each step counts [1].
    n_cells : int
        Number of cells.
    """
    gone = np.zeros((2, n_cells), np.int64)
    for start, end, weight in zip(before, after, weights, strict=True):
        if weight and (start.min() < 0 or end.min() < 0):
            for which, (seen, other) in enumerate(((start, end), (end, start))):
                alone = seen[(seen >= 0) & (other < 0)]
                gone[which] += weight * np.bincount(alone, minlength=n_cells)
    return gone


def _set_apart(parts: list[NDArray[np.int32]], n_cells: int) -> list[NDArray[np.int32]]:
    """Cells of the frames of steps; of a particle that one of them lacks, the state ``n_cells`` in all."""
    if not any(part.size and part.min() < 0 for part in parts):
        return parts
    unseen = np.logical_or.reduce([part < 0 for part in parts])
    return [np.where(unseen, np.int32(n_cells), part) for part in parts]


def step_starts(
    cells: NDArray[np.int32],
    lag: int,
    moves: int = 1,
    first: int = 0,
    last: int | None = None,
    step_weights: NDArray[np.int64] | None = None,
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Starting frames of the steps, and how many times each counts; arguments as `count_moves`.

    Parameters
    ----------
    moves : int
        Moves in a step, 1 of a cell and 2 of a pair; its frames are ``lag`` apart.

    Returns
    -------
    starts, weights : (n_steps,) int64 array

    Raises
    ------
    DataError
        No step fits, or the weights are too few, negative or all 0.
    """
    if cells.ndim != 2:
        raise DataError(f"cells of shape {cells.shape}, (frames, particles) expected")
    n_starts = len(cells) - moves * lag
    if lag < 1 or n_starts < 1:
        raise DataError(
            f"{len(cells)} frames hold no step of {moves} x {lag} frames: widen the window or cut the lag"
        )
    end = n_starts if last is None else min(last, n_starts)
    starts = np.arange(max(first, 0), end)
    if starts.size == 0:
        raise DataError(f"no step starts at frames {first} to {end}: the window is empty")
    if step_weights is None:
        return starts, np.ones(starts.size, np.int64)
    if len(step_weights) < n_starts or min(step_weights) < 0:
        raise DataError(
            f"{len(step_weights)} step weights for {n_starts} steps: give one for each step, none negative"
        )
    weights = np.asarray(step_weights, np.int64)[starts]
    if not weights.any():
        raise DataError("all step weights are 0: the window is empty")
    return starts, weights


def _csr(
    begins: NDArray[np.int64], columns: NDArray[np.int64], values: NDArray[np.float64], n_cells: int
) -> tuple[sparse.csr_array, sparse.csr_array]:
    """Counts and shares as sparse matrices; ``begins`` has the first entry of each row, and the end."""
    index = (columns.astype(np.int32), begins.astype(np.int32))
    shape = (begins.size - 1, n_cells)
    moves = sparse.csr_array((values[:, 0].astype(np.int64), *index), shape=shape)
    return moves, sparse.csr_array((values[:, 1].copy(), *index), shape=shape)
