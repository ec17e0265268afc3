# SPDX-License-Identifier: GPL-3.0-or-later
"""Hash tables of transition counts, filled by compiled code, with entries only for moves that occur.

A table is a tuple: keys (int64, -1 where free); values (float64, two for each key: the count of moves, exact
up to 2^53, and the sum over steps of N_ij / N_i); the binary logarithm of its size; and the number of keys.
"""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

FREE = np.int64(-1)
START_BITS = 14
# Multiplier of Fibonacci hashing (Knuth, TAOCP vol. 3, 6.4).
GOLDEN = np.uint64(0x9E3779B97F4A7C15)


@njit(cache=True)
def find_slot(keys, bits, key):  # type: ignore[no-untyped-def]
    """Slot of a key, or the free slot for it (linear probing)."""
    slot = (np.uint64(key) * GOLDEN) >> np.uint64(64 - bits)
    last = np.uint64(keys.size - 1)
    while keys[slot] != key and keys[slot] != FREE:
        slot = (slot + np.uint64(1)) & last
    return slot


@njit(cache=True)
def _doubled(keys, values, bits):  # type: ignore[no-untyped-def]
    more = np.full(2 * keys.size, FREE, np.int64)
    more_values = np.zeros((2 * keys.size, values.shape[1]), values.dtype)
    for old in range(keys.size):
        if keys[old] != FREE:
            slot = find_slot(more, bits + 1, keys[old])
            more[slot] = keys[old]
            for column in range(values.shape[1]):  # a whole row takes 4 s more to compile
                more_values[slot, column] = values[old, column]
    return more, more_values, bits + 1


@njit(cache=True)
def _add_to_occupied(held, n, weight, occupied, share):  # type: ignore[no-untyped-def]
    """Add a step to ``occupied`` of the first n cells (or pairs) with particles; set a particle's share."""
    for place in range(n):
        if held[place] > 0:
            occupied[place] += weight
            share[place] = weight / held[place]


@njit(cache=True)
def _add_moves(rows, columns, n_cells, weight, share, table):  # type: ignore[no-untyped-def]
    """Add one move of each particle, from its row to its column, with keys ``row * n_cells + column``."""
    keys, values, bits, used = table
    particle = 0
    while particle < rows.size:
        # Tables do not grow inside _add_until_full, which keeps its loop fast.
        particle, used = _add_until_full(
            rows, columns, particle, n_cells, weight, share, keys, values, bits, used
        )
        if particle < rows.size:
            keys, values, bits = _doubled(keys, values, bits)
    return keys, values, bits, used


@njit(cache=True)
def _add_until_full(rows, columns, first, n_cells, weight, share, keys, values, bits, used):  # type: ignore[no-untyped-def]
    """Add moves from particle ``first`` on; the particle at which the table is half full, or their number."""
    for particle in range(first, rows.size):
        row = np.uint64(rows[particle])
        key = np.int64(row) * n_cells + np.int64(columns[particle])
        slot = find_slot(keys, bits, key)
        if keys[slot] == FREE:
            if 2 * used >= keys.size:
                return particle, used
            keys[slot] = key
            used += 1
        values[slot, 0] += weight
        values[slot, 1] += share[row]
    return rows.size, used


@njit(cache=True)
def tally_moves(before, after, weights, occupied, table):  # type: ignore[no-untyped-def]
    """Add the moves of some steps to a table with keys ``i * n_cells + j``.

    Parameters
    ----------
    before, after : (n_steps, n_particles) int array
        Cells at the start and the end of each step.
    weights : (n_steps,) int64 array
        How many times each step counts [1].
    occupied : (n_cells,) int64 array
        Steps in which a cell held a particle; changed in place.
    table : tuple
        Counts of earlier steps.

    Returns
    -------
    tuple
        The table, perhaps a larger one.
    """
    n_cells = occupied.size
    held, share = np.zeros(n_cells, np.int64), np.zeros(n_cells)
    for step in range(before.shape[0]):
        weight = weights[step]
        if weight == 0:
            continue
        held[:] = 0
        for cell in before[step]:
            held[np.uint64(cell)] += 1
        _add_to_occupied(held, n_cells, weight, occupied, share)
        table = _add_moves(before[step], after[step], n_cells, weight, share, table)
    return table


def empty_table() -> tuple[Any, ...]:
    """Empty table."""
    size = 1 << START_BITS
    return np.full(size, FREE), np.zeros((size, 2)), START_BITS, 0


def table_entries(table: tuple[Any, ...]) -> tuple[NDArray[np.int64], NDArray[Any]]:
    """Keys in rising order, (n_used,), with their values, (n_used, n_columns)."""
    keys, values = table[:2]
    slots = np.flatnonzero(keys != FREE)
    keys, values = keys[slots], np.take(values, slots, axis=0)  # packed first: sorting reaches less memory
    order = np.argsort(keys)
    return keys[order], np.take(values, order, axis=0)
