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
            more_values[slot] = values[old]
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


@njit(cache=True)
def _number_pairs(first, second, n_cells, pairs, pair_of):  # type: ignore[no-untyped-def]
    """Set the number of each particle's pair, in order of appearance; new pairs are added."""
    keys, numbers, bits, used = pairs
    for particle in range(first.size):
        key = np.int64(first[particle]) * n_cells + np.int64(second[particle])
        slot = find_slot(keys, bits, key)
        if keys[slot] == FREE:
            if 2 * used >= keys.size:
                keys, numbers, bits = _doubled(keys, numbers, bits)
                slot = find_slot(keys, bits, key)
            keys[slot] = key
            numbers[slot, 0] = used
            used += 1
        pair_of[particle] = numbers[slot, 0]
    return keys, numbers, bits, used


@njit(cache=True)
def tally_pairs(first, second, third, weights, n_cells, pairs, occupied, table):  # type: ignore[no-untyped-def]
    """Add moves from pairs of cells (from i to j, then to k) to a table, keys ``pair * n_cells + k``.

    Parameters
    ----------
    first, second, third : (n_steps, n_particles) int array
        Cells one lag ago, now, and one lag later.
    weights : (n_steps,) int64 array
        How many times each step counts [1].
    n_cells : int
        Number of cells.
    pairs : tuple
        Table with keys ``i * n_cells + j``; its values number the pairs in order of appearance (int64).
    occupied : (n,) int64 array
        Steps in which each pair held a particle, by number; at least as long as there are pairs.
    table : tuple
        Counts of earlier steps.

    Returns
    -------
    pairs, occupied, table : tuple
        Perhaps larger ones.
    """
    pair_of = np.empty(first.shape[1], np.int64)
    held, share = np.zeros(occupied.size, np.int64), np.zeros(occupied.size)
    for step in range(first.shape[0]):
        weight = weights[step]
        if weight == 0:
            continue
        pairs = _number_pairs(first[step], second[step], n_cells, pairs, pair_of)
        if pairs[3] > occupied.size:
            occupied = np.concatenate((occupied, np.zeros(pairs[3], np.int64)))
            held, share = np.zeros(occupied.size, np.int64), np.zeros(occupied.size)
        held[:] = 0
        for pair in pair_of:
            held[np.uint64(pair)] += 1
        _add_to_occupied(held, pairs[3], weight, occupied, share)
        table = _add_moves(pair_of, third[step], n_cells, weight, share, table)
    return pairs, occupied, table


def empty_table(dtype: type = np.float64, columns: int = 2) -> tuple[Any, ...]:
    """Empty table; the table of pairs has one column of int64."""
    size = 1 << START_BITS
    return np.full(size, FREE), np.zeros((size, columns), dtype), START_BITS, 0


def table_entries(table: tuple[Any, ...]) -> tuple[NDArray[np.int64], NDArray[Any]]:
    """Keys in rising order, (n_used,), with their values, (n_used, n_columns)."""
    keys, values = table[:2]
    slots = np.flatnonzero(keys != FREE)
    keys, values = keys[slots], np.take(values, slots, axis=0)  # packed first: sorting reaches less memory
    order = np.argsort(keys)
    return keys[order], np.take(values, order, axis=0)
