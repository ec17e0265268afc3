# SPDX-License-Identifier: GPL-3.0-or-later
"""Transition counts of each block of a window apart: counts without a block at once, for error bars."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains.counting import Counts, count_moves, count_pairs
from bedchain.chains.sorted_counts import distinct
from bedchain.uncertainty.bands import block_edges


@dataclass(frozen=True)
class BlockCounts:
    """Moves from cell to cell, or from pair to cell, of each block of a window.

    Parameters
    ----------
    moves : (n_blocks, n_entries) int64 array
        N_ij of each block, by the entry (i, j) [1].
    shares : (n_blocks, n_entries) float64 array
        Sum over the steps of each block of N_ij / N_i [1].
    occupied : (n_blocks, n_rows) int64 array
        Steps of each block in which i held a particle [1].
    steps : (n_blocks,) int64 array
        Steps in each block [1].
    rows, columns : (n_entries,) int array
        The row i and the cell j of each entry, rising.
    n_cells : int
        Number of cells.
    lag : int
        Frames in a step.
    pairs : (n_rows, 2) int64 array or None
        As in `Counts`.
    """

    moves: NDArray[np.int64]
    shares: NDArray[np.float64]
    occupied: NDArray[np.int64]
    steps: NDArray[np.int64]
    rows: NDArray[np.int64]
    columns: NDArray[np.int32]
    n_cells: int
    lag: int
    pairs: NDArray[np.int64] | None = None

    def of(self, kept: NDArray[np.bool_]) -> Counts:
        """Counts of the blocks that are kept, (n_blocks,): those of `counting` without the other steps.

        Without the moves, and the rows of pairs, that occur in no block kept.
        """
        moves = _total(self.moves, kept)
        counted = moves > 0
        rows, occupied, pairs = self.rows[counted], _total(self.occupied, kept), None
        if self.pairs is not None:
            visited = np.zeros(len(self.pairs), bool)
            visited[rows] = True
            rows, occupied, pairs = (np.cumsum(visited) - 1)[rows], occupied[visited], self.pairs[visited]
        indptr = np.concatenate(([0], np.cumsum(np.bincount(rows, minlength=occupied.size))))
        index = (self.columns[counted], indptr.astype(np.int32))
        shape = (occupied.size, self.n_cells)
        matrix = sparse.csr_array((moves[counted], *index), shape=shape)
        shares = sparse.csr_array((_total(self.shares, kept)[counted], *index), shape=shape)
        return Counts(matrix, shares, occupied, int(self.steps[kept].sum()), self.lag, pairs)


def count_move_blocks(cells: NDArray[np.int32], n_cells: int, lag: int = 1, skipped: int = 0) -> BlockCounts:
    """Count the moves from cell to cell of each block of steps, in one pass over the frames.

    Parameters
    ----------
    cells : (n_frames, n_particles) int array
        Cell of each particle.
    n_cells : int
        Number of cells of the grid.
    lag : int
        Frames in a step.
    skipped : int
        Frames of the window before the first of ``cells``: the blocks are those of the window.

    Returns
    -------
    BlockCounts
    """
    edges = np.maximum(block_edges(len(cells) + skipped - lag) - skipped, 0)
    parts = _by_block(lambda first, last: count_moves(cells, n_cells, lag, first, last), edges)
    keys = [_keys(part.moves, np.arange(n_cells)) for part in parts]
    return _joined(parts, keys, np.stack([part.occupied for part in parts]), n_cells, None)


def count_pair_blocks(cells: NDArray[np.int32], n_cells: int, lag: int = 1) -> BlockCounts:
    """Count the moves from pairs of cells of each block of steps; arguments as `count_move_blocks`."""
    edges = block_edges(len(cells) - 2 * lag)
    parts = _by_block(lambda first, last: count_pairs(cells, n_cells, lag, first=first, last=last), edges)
    pair_keys = [part.pairs @ np.array([n_cells, 1]) for part in parts if part.pairs is not None]
    pairs = distinct(np.concatenate(pair_keys))
    places = [np.searchsorted(pairs, keys) for keys in pair_keys]
    occupied = np.zeros((len(parts), pairs.size), np.int64)
    for row, place, part in zip(occupied, places, parts, strict=True):
        row[place] = part.occupied
    keys = [_keys(part.moves, place) for part, place in zip(parts, places, strict=True)]
    return _joined(parts, keys, occupied, n_cells, np.column_stack(np.divmod(pairs, n_cells)))


def _by_block(count: Callable[[int, int], Counts], edges: NDArray[np.int64]) -> list[Counts]:
    ends = zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True)
    return [count(first, last) for first, last in ends]


def _joined(
    parts: Sequence[Counts],
    keys: Sequence[NDArray[np.int64]],
    occupied: NDArray[np.int64],
    n_cells: int,
    pairs: NDArray[np.int64] | None,
) -> BlockCounts:
    entries = distinct(np.concatenate(keys))
    moves, shares = np.zeros((len(parts), entries.size), np.int64), np.zeros((len(parts), entries.size))
    for row, (part, key) in enumerate(zip(parts, keys, strict=True)):
        place = np.searchsorted(entries, key)
        moves[row, place], shares[row, place] = part.moves.data, part.shares.data
    steps = np.array([part.steps for part in parts])
    rows, columns = np.divmod(entries, n_cells)
    return BlockCounts(
        moves, shares, occupied, steps, rows, columns.astype(np.int32), n_cells, parts[0].lag, pairs
    )


def _keys(moves: sparse.csr_array, places: NDArray[np.integer]) -> NDArray[np.int64]:
    """Entries of a matrix whose rows have given places, as rising numbers ``place * n_columns + column``."""
    rows = np.repeat(np.asarray(places, np.int64), np.diff(moves.indptr))
    return rows * moves.shape[1] + moves.indices


def _total(values: NDArray[Any], kept: NDArray[np.bool_]) -> NDArray[Any]:
    return np.asarray(values[kept].sum(axis=0))
