# SPDX-License-Identifier: GPL-3.0-or-later
"""Transition counts in a table of all pairs of cells, filled by compiled code.

Moves lead to cells nearby, which lie side by side in the table: 4 to 10 ns a move of the paper's bed. Only
the pages of pairs that occur are ever in memory.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

# a table of more pairs of cells takes more than 128 MiB
MOST_PAIRS = 1 << 23


class MoveTable:
    """Moves between cells, and in how many steps each cell held a particle.

    Parameters
    ----------
    n_cells : int
        At most the root of `MOST_PAIRS`.
    """

    def __init__(self, n_cells: int) -> None:
        # of each pair the count of moves, exact up to 2^53, and the sum over the steps of N_ij / N_i
        self.values = np.zeros((n_cells * n_cells, 2))
        self.occupied = np.zeros(n_cells, np.int64)
        # lowest and highest cell that moves lead to
        self.reach = np.tile(np.array([n_cells, -1]), (n_cells, 1))

    def add(self, before: NDArray[np.int32], after: NDArray[np.int32], weights: NDArray[np.int64]) -> None:
        """Add the moves of some steps.

        Parameters
        ----------
        before, after : (n_steps, n_particles) int array
            Cells at the start and the end of each step.
        weights : (n_steps,) int64 array
            How many times each step counts [1].
        """
        _tally(before, after, weights, self.occupied, self.reach, self.values)

    def entries(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
        """Rows and columns of the moves that occur, (n,), by row, then column; their values, (n, 2)."""
        keys = _keys(self.reach, self.values)
        rows, columns = np.divmod(keys, self.occupied.size)
        return rows, columns, np.take(self.values, keys, axis=0)


@njit(cache=True)
def _tally(before, after, weights, occupied, reach, values):  # type: ignore[no-untyped-def]
    n_cells = occupied.size
    held, share = np.zeros(n_cells, np.int64), np.zeros(n_cells)
    for step in range(before.shape[0]):
        weight = weights[step]
        if weight == 0:
            continue
        held[:] = 0
        for cell in before[step]:
            held[np.uint64(cell)] += 1
        for cell in range(n_cells):
            if held[cell] > 0:
                occupied[cell] += weight
                share[cell] = weight / held[cell]
        _add_moves(before[step], after[step], weight, share, reach, values)


@njit(cache=True)
def _add_moves(rows, columns, weight, share, reach, values):  # type: ignore[no-untyped-def]
    """Add one move of each particle, from its row to its column."""
    n_cells = np.uint64(share.size)
    for particle in range(rows.size):
        row, column = np.uint64(rows[particle]), np.uint64(columns[particle])
        pair = row * n_cells + column
        values[pair, 0] += weight
        values[pair, 1] += share[row]
        reach[row, 0] = min(reach[row, 0], columns[particle])
        reach[row, 1] = max(reach[row, 1], columns[particle])


@njit(cache=True)
def _keys(reach, values):  # type: ignore[no-untyped-def]
    """Pairs that occur, rising."""
    n_cells = reach.shape[0]
    most = 0
    for row in range(n_cells):
        most += max(reach[row, 1] - reach[row, 0] + 1, 0)
    keys, n_keys = np.empty(most, np.int64), 0
    for row in range(n_cells):
        for pair in range(row * n_cells + reach[row, 0], row * n_cells + reach[row, 1] + 1):
            if values[pair, 0] > 0:
                keys[n_keys] = pair
                n_keys += 1
    return keys[:n_keys].copy()
