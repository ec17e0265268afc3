# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves kept step by step add up to counts of any choice of steps."""

import numpy as np
import pytest

from bedchain.chains.counting import count_moves
from bedchain.chains.counting_by_step import count_steps
from bedchain.errors import DataError
from made.frames import hopping_cells

# Shares are sums of a few hundred fractions.
ROUND_OFF = 1e-12


@pytest.mark.parametrize("lag", [1, 3])
def test_weighted_steps_are_those_counted_with_weights(lag):
    cells = hopping_cells(3)
    by_step = count_steps(cells, 12, lag)
    for seed in range(3):
        weights = np.random.default_rng(seed).integers(0, 3, len(cells) - lag)
        added, counted = by_step.weighted(weights), count_moves(cells, 12, lag, step_weights=weights)
        assert (added.moves != counted.moves).nnz == 0 and added.moves.nnz == counted.moves.nnz
        assert abs(added.shares - counted.shares).max() < ROUND_OFF
        assert (added.occupied == counted.occupied).all()
        assert (added.steps, added.lag) == (counted.steps, counted.lag)


def test_too_few_frames_are_refused():
    with pytest.raises(DataError, match="hold no step"):
        count_steps(hopping_cells(3)[:2], 12, lag=2)
