# SPDX-License-Identifier: GPL-3.0-or-later
"""The dynamic chain: the next cell depends on the present and the previous cell (Zhuang et al. 2015, Eq. 2).

It is a chain of first order on pairs of cells. Its states are the pairs from which moves were counted, by
rising (previous, present) cell, followed by one state for each cell: particles of unknown past, which move as
in the static chain. A move into a pair from which no move was counted leads to the state of its cell.
"""

from collections.abc import Callable

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains.classes import traps
from bedchain.chains.counting import Counts, count_moves, count_pairs
from bedchain.chains.counting_by_block import BlockCounts, count_move_blocks, count_pair_blocks
from bedchain.chains.estimators import ROUND_OFF, estimated_rows, leak, transition_matrix
from bedchain.chains.markov_chain import MarkovChain
from bedchain.errors import DataError
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid


def learn(
    frames: Frames,
    grid: Grid,
    lag: int = 1,
    estimator: str = "pooled",
    step_weights: NDArray[np.int64] | None = None,
    single: Counts | None = None,
) -> MarkovChain:
    """Dynamic chain from a window of frames; arguments as `registry.learn`.

    ``single`` are the counts of `count_moves` with these arguments, where they are known.
    """
    cells = frames.cells
    if single is None:
        single = count_moves(cells, grid.n_cells, lag, step_weights=step_weights)
    double = count_pairs(cells, grid.n_cells, lag, step_weights=step_weights)
    return from_counts(double, single, grid, lag * frames.interval_s, estimator)


def relearner(
    frames: Frames, grid: Grid, lag: int = 1, estimator: str = "pooled", single: BlockCounts | None = None
) -> Callable[[NDArray[np.bool_]], MarkovChain]:
    """See `registry.relearner`; moves are counted once, those of cells only where ``single`` is missing."""
    blocks = single or count_move_blocks(frames.cells, grid.n_cells, lag)
    double, lag_s = count_pair_blocks(frames.cells, grid.n_cells, lag), lag * frames.interval_s
    return lambda kept: from_counts(double.of(kept), blocks.of(kept), grid, lag_s, estimator)


def from_counts(
    double: Counts, single: Counts, grid: Grid, lag_s: float, estimator: str = "pooled"
) -> MarkovChain:
    """Dynamic chain from counted moves of pairs and of single cells.

    Parameters
    ----------
    double : Counts
        From `counting.count_pairs`.
    single : Counts
        From `counting.count_moves`, of the same window.
    grid : Grid
        The cells.
    lag_s : float
        Length of a step [s].
    estimator : {"literal", "per_step", "pooled"}
        How counts become probabilities.

    Returns
    -------
    MarkovChain
        Its report holds the share of moves that fall back on the static chain, the leak, and the number of
        pairs opened.

    Raises
    ------
    DataError
        ``double`` are not counts of pairs.
    """
    if double.pairs is None:
        raise DataError("counts of single cells given, counts of pairs expected: count_pairs makes them")
    n_cells = grid.n_cells
    now = double.pairs[:, 1].astype(np.int32)
    keys = double.pairs @ np.array([n_cells, 1])
    rows = _stays(estimated_rows(double, estimator), now)
    static_rows = transition_matrix(single, estimator)
    both = sparse.csr_array(sparse.vstack((rows, static_rows), format="csr"))
    cell_of_state = np.concatenate((now, np.arange(n_cells, dtype=np.int32)))
    matrix, fell_back = _on_states(both, cell_of_state, keys, n_cells)
    matrix, opened = _open_pairs(matrix, cell_of_state, double.visits)
    visits = double.visits
    moves_back = np.repeat(visits, np.diff(rows.indptr)) * rows.data * fell_back[: rows.nnz]
    numbers = {
        "pairs_1": float(len(now)),
        "entries_1": float(matrix.nnz),
        "leak_1": leak(double) if estimator == "literal" else 0.0,
        "fallback_share_1": float(moves_back.sum() / visits.sum()),
        "pairs_opened_1": float(opened.size),
        "single_visit_pairs_1": float((visits == 1).sum()),
    }
    return MarkovChain("dynamic", grid, double.lag, lag_s, matrix, cell_of_state, 2, keys, len(now), numbers)


def _stays(rows: sparse.csr_array, now: NDArray[np.int32]) -> sparse.csr_array:
    """Rows filled up to 1 by the probability of staying in the present cell."""
    missing = 1.0 - np.asarray(rows.sum(axis=1)).ravel()
    lost = np.flatnonzero(missing > ROUND_OFF)
    if lost.size == 0:
        return rows
    stay = sparse.csr_array((missing[lost], (lost, now[lost])), shape=rows.shape)
    return sparse.csr_array(rows + stay)


def _on_states(
    both: sparse.csr_array, cell_of_state: NDArray[np.int32], keys: NDArray[np.int64], n_cells: int
) -> tuple[sparse.csr_array, NDArray[np.bool_]]:
    """Matrix with states (present, k) in place of cells k as columns, and for each entry if it falls back.

    An entry falls back on the state of cell k where the pair (present, k) is no state.
    """
    columns, fell_back = np.empty(both.nnz, np.int32), np.empty(both.nnz, bool)
    begins = np.searchsorted(keys, np.arange(n_cells + 1) * n_cells)
    by_cell = np.argsort(cell_of_state, kind="stable")
    _find_states(both.indptr, both.indices, cell_of_state, by_cell, keys, begins, columns, fell_back)
    lengths = np.diff(both.indptr)
    data = both.data / np.repeat(np.asarray(both.sum(axis=1)).ravel(), lengths)
    shape = (both.shape[0], both.shape[0])
    matrix = sparse.csr_array((data, columns, both.indptr.astype(np.int32)), shape=shape)
    return matrix, fell_back


@njit(cache=True)
def _find_states(indptr, indices, cell_of_state, by_cell, keys, begins, columns, fell_back):  # type: ignore[no-untyped-def]
    """State of each entry, and whether it falls back.

    ``by_cell`` are the rows by their cell, ``begins`` the first pairs from each cell.
    """
    n_cells, last = begins.size - 1, np.int64(-1)
    state_of = np.full(n_cells, -1, np.int64)  # of each next cell from the last cell
    for row in by_cell:
        cell = cell_of_state[row]
        if cell != last:
            if last >= 0:
                for pair in range(begins[last], begins[last + 1]):
                    state_of[keys[pair] - last * n_cells] = -1
            for pair in range(begins[cell], begins[cell + 1]):
                state_of[keys[pair] - np.int64(cell) * n_cells] = pair
            last = np.int64(cell)
        for entry in range(indptr[row], indptr[row + 1]):
            state = state_of[indices[entry]]
            fell_back[entry] = state < 0
            columns[entry] = keys.size + indices[entry] if state < 0 else state


def _open_pairs(
    matrix: sparse.csr_array, cell_of_state: NDArray[np.int32], visits: NDArray[np.int64]
) -> tuple[sparse.csr_array, NDArray[np.int64]]:
    """Matrix in which pairs of entered traps (`classes.traps`) have the static row of their cell.

    Returns
    -------
    matrix : csr_array
    opened : int64 array
        Pairs that were changed, rising.
    """
    n_pairs = visits.size
    padded = np.concatenate((visits, np.zeros(matrix.shape[0] - n_pairs, np.int64)))
    opened = np.zeros(0, np.int64)
    while True:
        trap = traps(matrix, padded)
        moves = sparse.coo_array(matrix[:n_pairs])
        entered = np.unique(trap[moves.col[trap[moves.row] != trap[moves.col]]])
        shut = np.flatnonzero(np.isin(trap[:n_pairs], entered[entered >= 0]))
        new = np.setdiff1d(shut, opened)
        if new.size == 0:
            return matrix, opened
        source = np.arange(matrix.shape[0])
        source[new] = n_pairs + cell_of_state[new]
        matrix = sparse.csr_array(matrix[source])
        opened = np.union1d(opened, new)
