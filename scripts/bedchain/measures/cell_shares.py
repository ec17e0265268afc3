# SPDX-License-Identifier: GPL-3.0-or-later
"""Share of each cell that lies in a part of the bed, whatever the form of the cells."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bedchain.trajectory.grid import Grid

# points in a cell, in a ring, which is a whole turn, and in all cells at most; powers of two
POINTS, POINTS_OF_RING, MOST_POINTS = 512, 2048, 4_194_304

Places = NDArray[Any]


def shares_inside(grid: Grid, inside: Callable[[Places, Places, Places], Places]) -> NDArray[np.float64]:
    """Share of each cell's volume in a part of the bed, by points spread evenly in the cell (Sobol).

    Parameters
    ----------
    grid : Grid
    inside : callable
        From places x, z, y [m] to bools.

    Returns
    -------
    (n_cells,) array
        [1], to 0.01 in most grids.
    """
    from scipy.stats import qmc  # late: scipy.stats takes a second to load

    wanted = min(POINTS_OF_RING if grid.form == "rings" else POINTS, MOST_POINTS // grid.n_cells)
    doublings = max(3, int(np.log2(max(1, wanted))))
    points = qmc.Sobol(3, scramble=False).random_base2(doublings) + 0.5 / 2**doublings
    index, names = grid.indices(np.arange(grid.n_cells)), grid.coordinates.names
    total, hit = np.zeros(grid.n_cells), np.zeros(grid.n_cells)
    for point in points:
        first, second, third = [
            (i + offset) * (length / count)
            for i, offset, length, count in zip(index, point, grid.lengths_m, grid.counts, strict=True)
        ]
        # a point far from the axis of a cylinder stands for more volume
        weight = (first, second, third)[names.index("r")] if "r" in names else np.ones(grid.n_cells)
        total += weight
        hit += weight * inside(*grid.coordinates.place(first, second, third, grid.size))
    return hit / total
