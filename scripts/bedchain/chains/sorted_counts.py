# SPDX-License-Identifier: GPL-3.0-or-later
"""Transition counts of paths of cells by sorting, for counts in which most moves occur once or twice.

A move is one number: its path of cells, its step, and the cell that it leads to, in fields of bits. Sorted,
the moves of a path lie together, step by step, and one pass counts them: 0.1 to 0.3 us a move. A table of all
pairs of cells (`dense_counts`) is faster where it fits into memory.
"""

from collections.abc import Sequence

import numpy as np
from numba import njit
from numpy.typing import NDArray

from bedchain.errors import DataError

KEY_BITS = 63
Entries = tuple[NDArray[np.int64], NDArray[np.float64]]
NO_ENTRIES: Entries = (np.zeros(0, np.int64), np.zeros((0, 3)))


class SortedMoves:
    """Moves between cells as in `dense_counts.MoveTable`, for any number of cells."""

    def __init__(self, n_cells: int) -> None:
        self.n_cells, self.bits, self._moves = n_cells, cell_bits(n_cells), NO_ENTRIES

    def add(self, before: NDArray[np.int32], after: NDArray[np.int32], weights: NDArray[np.int64]) -> None:
        """See `dense_counts.MoveTable.add`."""
        self._moves = merged(self._moves, counted_paths((before, after), weights, self.bits))

    def entries(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
        """See `dense_counts.MoveTable.entries`."""
        keys, values = self._moves
        return keys >> self.bits, keys & (1 << self.bits) - 1, values[:, :2]

    @property
    def occupied(self) -> NDArray[np.int64]:
        """Steps in which each cell held a particle, (n_cells,) [1]."""
        keys, values = self._moves
        return np.bincount(keys >> self.bits, values[:, 2], self.n_cells).astype(np.int64)


def cell_bits(n_states: int) -> int:
    """Bits that hold the number of any of some states [1]."""
    return max(int(n_states - 1).bit_length(), 1)


def counted_paths(parts: Sequence[NDArray[np.int32]], weights: NDArray[np.int64], bits: int) -> Entries:
    """Moves of some steps, counted by their path and the cell that they lead to.

    Parameters
    ----------
    parts : list of (n_steps, n_particles) int32 array
        Cells of the particles before each move, oldest first, and after the last one.
    weights : (n_steps,) int64 array
        How many times each step counts [1].
    bits : int
        Of a cell's number: `cell_bits`.

    Returns
    -------
    keys : (n_entries,) int64 array
        Cells of each entry as fields of bits, the oldest first, rising.
    values : (n_entries, 3) float64 array
        Times that the move occurs; sum over the steps of its share among the moves of its path; a part of the
        steps in which its path held a particle, which the entries of a path add up to [1].

    Raises
    ------
    DataError
        The cells are too many for paths of so many moves.
    """
    step_bits = KEY_BITS - bits * len(parts)
    if step_bits < 0:
        raise DataError(f"paths of {len(parts)} cells of {1 << (bits - 1)} or more: make the cells larger")
    entries, span = NO_ENTRIES, 1 << step_bits
    for first in range(0, len(weights), span):
        some = slice(first, first + span)
        entries = merged(entries, _counted([part[some] for part in parts], weights[some], bits))
    return entries


def distinct(keys: NDArray[np.int64]) -> NDArray[np.int64]:
    """Distinct numbers, rising; of ten million in a fiftieth of the time of `numpy.unique`, which hashes."""
    ordered = np.sort(keys)
    return ordered[np.diff(ordered, prepend=ordered[:1] - 1) > 0]


def merged(one: Entries, other: Entries) -> Entries:
    """Entries of two sets of steps together; an entry of both has the sums of their values."""
    if one[0].size == 0 or other[0].size == 0:
        return other if one[0].size == 0 else one
    return _merged(*one, *other)


def _counted(parts: Sequence[NDArray[np.int32]], weights: NDArray[np.int64], bits: int) -> Entries:
    step_bits = int(len(weights) - 1).bit_length()
    keys = parts[0].astype(np.int64)
    for part in parts[1:-1]:
        keys <<= bits
        keys |= part
    keys <<= step_bits
    keys |= np.arange(len(weights))[:, None]
    keys <<= bits
    keys |= parts[-1]
    keys = (keys if weights.all() else keys[weights > 0]).ravel()
    keys.sort()
    return _of_sorted(keys, np.asarray(weights, np.float64), step_bits, bits)


@njit(cache=True)
def _of_sorted(keys, weights, step_bits, bits):  # type: ignore[no-untyped-def]
    """Entries of sorted moves (path, step, cell)."""
    cell_of, step_of = (np.int64(1) << bits) - 1, (np.int64(1) << step_bits) - 1
    count, share, touched = np.zeros(cell_of + 1), np.zeros(cell_of + 1), np.empty(cell_of + 1, np.int64)
    # far fewer entries than moves: zeros would touch all of it
    entry_keys, values = np.empty(keys.size, np.int64), np.empty((keys.size, 3))
    begin, n_entries = 0, 0
    while begin < keys.size:
        path, occupied, n_touched = keys[begin] >> (bits + step_bits), 0.0, 0
        while begin < keys.size and keys[begin] >> (bits + step_bits) == path:
            step, end = keys[begin] >> bits, begin + 1
            while end < keys.size and keys[end] >> bits == step:
                end += 1
            weight = weights[step & step_of]
            occupied += weight
            for move in range(begin, end):
                cell = keys[move] & cell_of
                if count[cell] == 0.0:
                    touched[n_touched] = cell
                    n_touched += 1
                count[cell] += weight
                share[cell] += weight / (end - begin)
            begin = end
        touched[:n_touched].sort()
        for cell in touched[:n_touched]:
            entry_keys[n_entries] = (path << bits) | cell
            values[n_entries, 0], values[n_entries, 1] = count[cell], share[cell]
            values[n_entries, 2], occupied = occupied, 0.0
            count[cell], share[cell] = 0.0, 0.0
            n_entries += 1
    return entry_keys[:n_entries].copy(), values[:n_entries].copy()


@njit(cache=True)
def _merged(keys, values, other_keys, other_values):  # type: ignore[no-untyped-def]
    """See `merged`; both have rising keys."""
    size, width = keys.size + other_keys.size, values.shape[1]
    all_keys, all_values = np.empty(size, np.int64), np.empty((size, width))
    at, place, n = 0, 0, 0
    while at < keys.size or place < other_keys.size:
        first = place == other_keys.size or (at < keys.size and keys[at] <= other_keys[place])
        second = at == keys.size or (place < other_keys.size and other_keys[place] <= keys[at])
        all_keys[n] = keys[at] if first else other_keys[place]
        for column in range(width):
            all_values[n, column] = 0.0
            if first:
                all_values[n, column] += values[at, column]
            if second:
                all_values[n, column] += other_values[place, column]
        at, place, n = at + first, place + second, n + 1
    return all_keys[:n].copy(), all_values[:n].copy()
