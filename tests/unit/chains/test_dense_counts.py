# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of moves against a plain counter, and beside moves counted by sorting."""

from collections import Counter

import numpy as np
import pytest

from bedchain.chains.dense_counts import MoveTable
from bedchain.chains.sorted_counts import SortedMoves

N_CELLS = 300


@pytest.mark.parametrize("kind", [MoveTable, SortedMoves])
def test_a_table_holds_what_a_counter_holds(kind):
    rng = np.random.default_rng(1)
    before, after = rng.integers(0, N_CELLS, (2, 3, 5_000)).astype(np.int32)
    before[before == 7] = 8
    weights, table = np.array([1, 0, 2]), kind(N_CELLS)
    for some in (slice(0, 2), slice(2, 3)):
        table.add(before[some], after[some], weights[some])
    rows, columns, values = table.entries()
    counter: Counter = Counter()
    held: Counter = Counter()
    for step in (0, 2, 2):
        counter.update(zip(before[step].tolist(), after[step].tolist(), strict=True))
        held.update(set(before[step].tolist()))
    moves = list(zip(rows.tolist(), columns.tolist(), strict=True))
    assert moves == sorted(counter) and values[:, 0].tolist() == [counter[move] for move in moves]
    assert table.occupied.tolist() == [held[cell] for cell in range(N_CELLS)] and table.occupied[7] == 0
    # each occupied cell sends on the whole of itself in each step
    assert np.bincount(rows, values[:, 1], N_CELLS) == pytest.approx(table.occupied, rel=1e-12)
