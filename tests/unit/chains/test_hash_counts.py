# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of moves against a plain counter, also where they grow."""

from collections import Counter

import numpy as np
import pytest

from bedchain.chains import hash_counts

N_CELLS = 300  # 90 000 possible moves: the table of 16 384 slots must double twice


def test_a_table_that_grows_holds_what_a_counter_holds():
    rng = np.random.default_rng(1)
    before, after = rng.integers(0, N_CELLS, (2, 3, 15_000)).astype(np.int32)
    weights, occupied = np.array([1, 0, 2]), np.zeros(N_CELLS, np.int64)
    table = hash_counts.tally_moves(before, after, weights, occupied, hash_counts.empty_table())
    keys, values = hash_counts.table_entries(table)
    counter: Counter = Counter()
    for step in (0, 2, 2):
        counter.update((before[step].astype(int) * N_CELLS + after[step]).tolist())
    assert table[0].size > 1 << hash_counts.START_BITS and 2 * table[3] <= table[0].size + 2
    assert keys.tolist() == sorted(counter)
    assert values[:, 0].tolist() == [counter[key] for key in keys.tolist()]
    # each occupied cell sends on the whole of itself in each step
    assert values[:, 1].sum() == pytest.approx(occupied.sum(), rel=1e-12)


def test_a_slot_is_found_again_and_a_free_one_where_there_is_none():
    keys = np.full(8, hash_counts.FREE)
    # all keys that start at the same slot of eight: they stand one after the other
    alike = [
        key for key in range(200) if hash_counts.find_slot(keys, 3, key) == hash_counts.find_slot(keys, 3, 0)
    ]
    for place, key in enumerate(alike[:4]):
        slot = hash_counts.find_slot(keys, 3, key)
        assert (
            keys[slot] == hash_counts.FREE and slot == (hash_counts.find_slot(keys, 3, alike[0]) + place) % 8
        )
        keys[slot] = key
    assert [keys[hash_counts.find_slot(keys, 3, key)] for key in alike[:4]] == alike[:4]
