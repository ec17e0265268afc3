# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves kept block by block add up to counts of any choice of blocks."""

import numpy as np
import pytest

from bedchain.chains.counting import count_moves, count_pairs
from bedchain.chains.counting_by_block import count_move_blocks, count_pair_blocks
from bedchain.errors import DataError
from bedchain.uncertainty.bands import kept_blocks, kept_steps
from made.frames import hopping_cells

# Shares are sums of a few hundred fractions.
ROUND_OFF = 1e-12
CHOICES = [*kept_blocks(), np.ones(5, bool), np.array([0, 1, 0, 0, 1], bool)]


def assert_same(added, counted):
    assert (added.moves != counted.moves).nnz == 0 and added.moves.nnz == counted.moves.nnz
    assert abs(added.shares - counted.shares).max() < ROUND_OFF
    assert (added.occupied == counted.occupied).all()
    assert (added.steps, added.lag) == (counted.steps, counted.lag)


@pytest.mark.parametrize("lag", [1, 3])
def test_blocks_of_moves_are_those_counted_with_weights(lag):
    cells = hopping_cells(3)
    blocks = count_move_blocks(cells, 12, lag)
    for kept in CHOICES:
        weights = kept_steps(kept, len(cells) - lag)
        assert_same(blocks.of(kept), count_moves(cells, 12, lag, step_weights=weights))


@pytest.mark.parametrize("lag", [1, 3])
def test_blocks_of_pairs_are_those_counted_with_weights(lag):
    cells = hopping_cells(4)
    blocks = count_pair_blocks(cells, 12, lag)
    for kept in CHOICES:
        weights = kept_steps(kept, len(cells) - 2 * lag)
        added, counted = blocks.of(kept), count_pairs(cells, 12, lag, step_weights=weights)
        assert_same(added, counted)
        assert (added.pairs == counted.pairs).all()


def test_blocks_of_a_window_whose_first_frames_hold_no_states():
    cells = hopping_cells(5)
    weights = kept_steps(CHOICES[1], len(cells) - 1)
    later = count_move_blocks(cells[4:], 12, skipped=4).of(CHOICES[1])
    assert_same(later, count_moves(cells[4:], 12, step_weights=weights[4:]))


def test_too_few_frames_are_refused():
    with pytest.raises(DataError, match="hold no step"):
        count_move_blocks(hopping_cells(3)[:2], 12, lag=2)
