# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of maps: the same height whatever is drawn, and cells in the order of their numbers."""

import numpy as np
import pytest

from bedchain.figures.maps import cell_columns, height_to_show
from bedchain.trajectory.cell_store import CellStore
from bedchain.trajectory.grid import Grid

MOMENTS = np.array([0.0, 0.1])


def store(grid, *rows):
    """Two frames; in each a thousand particles from the bottom up to a row, evenly."""
    cells = np.array([np.arange(1000) % (row + 1) * grid.columns for row in rows], np.int32)
    return CellStore(cells, MOMENTS, grid)


def test_height_is_that_of_the_highest_moment_and_a_row():
    grid = Grid(0.02, 0.3, 2, 30)
    assert height_to_show(store(grid, 3, 6), MOMENTS, 0.0) == pytest.approx(0.08)


def test_a_splash_is_not_worth_the_room():
    grid = Grid(0.02, 0.3, 2, 30)
    splashed = store(grid, 3, 6)
    splashed.cells[0, 0] = 29 * grid.columns
    assert height_to_show(splashed, MOMENTS, 0.0) == pytest.approx(0.08)


@pytest.mark.parametrize(("width", "rows", "height"), [(0.2, 1, 0.2), (0.01, 29, 0.08), (0.2, 29, 0.3)])
def test_maps_are_neither_flat_nor_slender_nor_above_the_bed(width, rows, height):
    grid = Grid(width, 0.3, 2, 30)
    assert height_to_show(store(grid, 0, rows), MOMENTS, 0.0) == pytest.approx(height)


def test_cells_stand_in_the_order_of_their_numbers_at_each_moment():
    grid = Grid(0.02, 0.03, 2, 3)
    table = cell_columns(grid, MOMENTS)
    assert table["cell"].tolist() == [*range(6)] * 2
    assert (table["cell"] == table["row"] * 2 + table["column"]).all()
    np.testing.assert_allclose(table.loc[5, ["time_s", "x_m", "z_m"]].astype(float), [0.0, 0.015, 0.025])
