# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.regrid import regrid

ROUND_OFF = 1e-12


def test_the_same_grid_changes_nothing():
    grid, shares = Grid(0.1, 0.4, 5, 7), np.random.default_rng(1).random((3, 2, 35))
    assert np.abs(regrid(shares, grid, grid) - shares).max() < ROUND_OFF


def test_finer_cells_add_up_and_coarser_ones_spread_evenly():
    coarse, fine = Grid(0.2, 0.2, 1, 2), Grid(0.2, 0.2, 2, 4)
    by_fine = np.arange(8.0)
    assert regrid(by_fine, fine, coarse).tolist() == [0 + 1 + 2 + 3, 4 + 5 + 6 + 7]
    assert regrid(np.array([4.0, 8.0]), coarse, fine) == pytest.approx([1, 1, 1, 1, 2, 2, 2, 2])


def test_grids_that_do_not_nest_keep_the_sum_and_the_place():
    rng = np.random.default_rng(2)
    given, wanted = Grid(0.27, 1.05, 27, 105), Grid(0.27, 1.05, 14, 52)
    shares = rng.dirichlet(np.ones(given.n_cells))
    found = regrid(shares, given, wanted)
    assert found.sum() == pytest.approx(1.0, abs=ROUND_OFF) and found.min() >= 0
    # spreading inside cells keeps the mean place exactly, up to half a cell of the grid that is cut
    assert found @ wanted.centres_m == pytest.approx(shares @ given.centres_m, abs=given.cell_width_m / 2)
    x, z = rng.random((2, 200_000)) * [[0.27], [1.05]]
    seen = np.bincount(wanted.cell_of(x, z), minlength=wanted.n_cells) / x.size
    uniform = regrid(np.full(given.n_cells, 1 / given.n_cells), given, wanted)
    assert np.abs(seen - uniform).max() < 6 * np.sqrt(uniform.max() / x.size)


def test_grids_of_two_beds_are_refused():
    with pytest.raises(DataError, match="two beds"):
        regrid(np.ones(4), Grid(0.1, 0.1, 2, 2), Grid(0.2, 0.1, 2, 2))
