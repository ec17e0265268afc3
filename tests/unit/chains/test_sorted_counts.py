# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves counted by sorting against a plain counter, also where a key has no bits for several steps."""

from collections import Counter

import numpy as np
import pytest

from bedchain.chains.sorted_counts import cell_bits, counted_paths, distinct, merged
from bedchain.errors import DataError

WEIGHTS = np.array([1, 0, 2, 1])


def by_hand(parts, bits):
    """Count of each key, and steps that each path of all cells but the last is occupied in."""
    counts: Counter = Counter()
    occupied: Counter = Counter()
    for step, weight in enumerate(WEIGHTS.tolist()):
        moves = [sum(int(cell) << bits * ago for ago, cell in enumerate(path[::-1]))
                 for path in zip(*(part[step] for part in parts), strict=True)]  # fmt: skip
        for key in moves * weight:
            counts[key] += 1
        for path in {key >> bits for key in moves}:
            occupied[path] += weight
    return counts, +occupied


@pytest.mark.parametrize(("moves", "bits"), [(1, 3), (2, 3), (2, 21)])
def test_entries_are_those_of_a_counter(moves, bits):
    rng = np.random.default_rng(3)
    parts = rng.integers(0, 8, (moves + 1, WEIGHTS.size, 50)).astype(np.int32)
    keys, values = counted_paths(parts, WEIGHTS, bits)
    counts, occupied = by_hand(parts, bits)
    assert keys.tolist() == sorted(counts) and values[:, 0].tolist() == [counts[key] for key in keys.tolist()]
    summed: Counter = Counter()
    for key, steps in zip(keys.tolist(), values[:, 2].tolist(), strict=True):
        summed[key >> bits] += steps
    assert summed == occupied
    # each path sends on the whole of itself in each step
    assert values[:, 1].sum() == pytest.approx(sum(occupied.values()), rel=1e-12)


def test_entries_of_two_sets_of_steps_add_up():
    parts = np.random.default_rng(4).integers(0, 5, (2, WEIGHTS.size, 30)).astype(np.int32)
    whole = counted_paths(parts, WEIGHTS, 3)
    halves = [counted_paths(parts[:, half], WEIGHTS[half], 3) for half in (slice(0, 2), slice(2, 4))]
    keys, values = merged(*halves)
    assert (keys == whole[0]).all() and np.abs(values - whole[1])[:, :2].max() < 1e-12
    assert values[:, 2].sum() == whole[1][:, 2].sum()


def test_more_cells_than_bits_are_refused_and_bits_hold_the_last_cell():
    assert [cell_bits(n) for n in (1, 2, 3, 4, 5, 2836)] == [1, 1, 2, 2, 3, 12]
    with pytest.raises(DataError, match="make the cells larger"):
        counted_paths(np.zeros((3, 1, 1), np.int32), np.ones(1, np.int64), 22)


def test_distinct_numbers_rise():
    assert distinct(np.array([5, 2, 5, -1, 2])).tolist() == [-1, 2, 5]
    assert distinct(np.zeros(0, np.int64)).size == 0
