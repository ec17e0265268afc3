# SPDX-License-Identifier: GPL-3.0-or-later
"""The batch, its distribution, and the table of costs, by hand."""

import numpy as np
import pytest

from bedchain.errors import UserError
from bedchain.measures.batch import (
    batch_of,
    expected_total_variation,
    observed_shares,
    share_by_cell,
    total_variation,
)
from bedchain.trajectory.cell_store import CellStore
from bedchain.trajectory.grid import Grid

GRID = Grid(0.02, 0.03, 2, 3)


def test_batch_is_the_lowest_rows():
    cells = np.array([0, 1, 2, 3, 4, 5])
    np.testing.assert_array_equal(batch_of(GRID, cells, 0.01), [1, 1, 0, 0, 0, 0])
    np.testing.assert_array_equal(batch_of(GRID, cells, 0.019), [1, 1, 1, 1, 0, 0])
    # lower than a row is still one row
    np.testing.assert_array_equal(batch_of(GRID, cells, 0.001), [1, 1, 0, 0, 0, 0])


def test_empty_batch_is_refused():
    with pytest.raises(UserError, match="batch_height_m"):
        batch_of(GRID, np.array([4, 5]), 0.01)


def test_shares_by_hand():
    np.testing.assert_array_equal(share_by_cell(np.array([0, 0, 5, 2]), 6), [0.5, 0, 0.25, 0, 0, 0.25])


def test_observed_shares_follow_the_batch_only():
    cells = np.array([[0, 1, 4], [2, 1, 4], [2, 3, 0]], np.int32)
    store = CellStore(cells, np.array([1.0, 1.5, 2.0]), GRID)
    shares = observed_shares(store, np.array([0.5, 1.0]), 1.0, 0.01)
    np.testing.assert_array_equal(shares, [[0, 0.5, 0.5, 0, 0, 0], [0, 0, 0.5, 0.5, 0, 0]])


def test_total_variation_by_hand():
    assert total_variation(np.array([1.0, 1, 0]), np.array([0, 0.1, 0.1])) == pytest.approx(0.5)


def test_expected_total_variation_is_the_mean_of_draws():
    # one coin of two: 0 or 1 heads, both 1/2 off
    assert expected_total_variation(np.array([0.5, 0.5, 0.0]), 1) == pytest.approx(0.5)
    assert expected_total_variation(np.array([2.0, 0.0]), 7) == 0
    shares, number = np.array([0.5, 0.3, 0.199, 0.001]), 40
    drawn = np.random.default_rng(1).multinomial(number, shares, 4000) / number
    distances = 0.5 * np.abs(drawn - shares).sum(axis=1)
    error = distances.std() / np.sqrt(len(distances))
    assert expected_total_variation(shares, number) == pytest.approx(distances.mean(), abs=4 * error)
