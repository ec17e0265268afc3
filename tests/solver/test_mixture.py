# SPDX-License-Identifier: GPL-3.0-or-later
"""Two sizes of spheres on a rough slope of LIGGGHTS: they segregate, in the DEM and in chains of each."""

import numpy as np
import pytest

from bedchain.comparison.segregation import Mixture, segregation_table
from bedchain.trajectory.grid import Grid
from made.decks import run_deck

INTERVAL_S, LAG = 0.04, 1
FALLEN, STEADY = 3, 30  # frames until all are down, and until the mean index no longer falls
BETWEEN = 1e-3  # a particle may be so far beyond a periodic side [m]


@pytest.fixture(scope="module")
def slope(tmp_path_factory):
    """Cells of all frames on a division along the height alone, the grid, and the small ones."""
    scene = run_deck("in.mixture", tmp_path_factory.mktemp("slope"))
    grid = Grid(0.024, 0.05, 1, 10)
    x = np.clip(scene.values[:, 0], 0, grid.width_m)
    assert np.abs(x - scene.values[:, 0]).max() < BETWEEN
    return grid.cell_of(x, scene.values[:, 1]), grid, scene.radius_m < 1.5e-3


def numbers(table, quantity):
    """Means of a quantity over the second half, by source, with bands."""
    part = table[(table["quantity"] == quantity) & table["time_s"].isna()]
    return part.set_index("source")[["value", "ci_low", "ci_high"]]


def test_chains_of_each_size_segregate_as_the_dem_does_and_one_chain_does_not(slope):
    cells, grid, small = slope
    mixture = Mixture(grid, cells[STEADY:], cells[FALLEN:], small, True, LAG, INTERVAL_S)
    table = segregation_table("small", mixture, 3)
    lacey, height = numbers(table, "lacey_index"), numbers(table, "height_separation")
    start = table[(table["source"] == "dem") & (table["quantity"] == "lacey_index")]["value"].iloc[0]
    assert start > 0.9  # mixed at first
    assert lacey.loc["dem", "ci_high"] < 0.8 and height.loc["dem", "ci_high"] < -0.3
    for part in (lacey, height):
        low, high = (
            part.loc[["dem", "chain_by_mark"], "ci_low"].max(),
            part.loc[["dem", "chain_by_mark"], "ci_high"].min(),
        )
        assert low < high  # the bands meet
    assert lacey.loc["chain", "ci_low"] > 0.9 and height.loc["chain", "ci_low"] > -0.2
