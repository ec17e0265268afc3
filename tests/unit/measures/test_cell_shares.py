# SPDX-License-Identifier: GPL-3.0-or-later
"""Shares of cells in parts of the bed, by hand and by many random places."""

import numpy as np
import pytest

from bedchain.measures.cell_shares import shares_inside
from bedchain.measures.mixing import side_shares
from bedchain.trajectory.grid import Grid

SAMPLED = 0.02  # a plane through a cell by its points, and by the random places


def test_a_tilted_plane_halves_the_cells_that_it_goes_through():
    grid = Grid(1.0, 1.0, 2, 2)
    shares = shares_inside(grid, lambda x, z, y: x + z < 1.0)
    assert shares[0] == 1 and shares[3] == 0
    np.testing.assert_allclose(shares[1:3], 0.5, atol=1 / 8)


@pytest.mark.parametrize(
    "grid",
    [
        Grid(0.2, 0.2, 5, 3, 0.3, 2, form="sectors", axis="horizontal"),
        Grid(0.2, 0.2, 3, 3, 0.2, form="rings"),
    ],
)
def test_volumes_on_each_side_of_a_round_bed_are_those_of_its_halves(grid):
    rng = np.random.default_rng(5)
    x, z, y = (length * rng.random(1_000_000) for length in grid.size)
    other = z if grid.axis == "horizontal" else y
    inside = np.hypot(x - 0.1, other - 0.1) < 0.1
    x, z, y = x[inside], z[inside], y[inside]
    cells = grid.cell_of(x, z, y_m=y)
    held = np.bincount(cells, minlength=grid.n_cells)
    shares = side_shares(grid, 0.07, 0.12)
    np.testing.assert_allclose(
        shares[0], np.bincount(cells[x < 0.07], minlength=grid.n_cells) / held, atol=SAMPLED
    )
    np.testing.assert_allclose(
        shares[2], np.bincount(cells[z < 0.12], minlength=grid.n_cells) / held, atol=SAMPLED
    )
