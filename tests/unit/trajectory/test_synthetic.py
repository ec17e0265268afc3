# SPDX-License-Identifier: GPL-3.0-or-later
"""The made-up bubbling bed of the benchmarks."""

import numpy as np

from bedchain.trajectory.grid import Grid
from bedchain.trajectory.synthetic import REST_HEIGHT_M, write_cells

GRID = Grid(0.27, 1.05, 9, 35)


def test_particles_stay_inside_move_and_are_the_same_for_the_same_seed(tmp_path):
    for name, seed, places in (("a", 1, False), ("b", 1, False), ("c", 2, False), ("places", 1, True)):
        write_cells(tmp_path / f"{name}.npy", GRID, 2000, 40, seed, places=places)
    cells, again, other, places = (np.load(tmp_path / f"{name}.npy") for name in ("a", "b", "c", "places"))
    assert (cells == again).all() and (cells != other).any()
    # positions in single precision may lie on the other side of an edge
    assert (GRID.cell_of(places[:, 0], places[:, 1]) == cells).mean() > 0.999
    # about as in a bed: 1 to 3 cells of 3 cm are reached in 0.025 s, and it does not blow away
    assert 0.05 < (cells[1:] != cells[:-1]).mean() < 0.6
    assert 0.5 * REST_HEIGHT_M < 2 * places[-1, 1].mean() < 1.5 * REST_HEIGHT_M
