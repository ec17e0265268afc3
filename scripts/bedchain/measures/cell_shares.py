# SPDX-License-Identifier: GPL-3.0-or-later
"""Share of each cell that lies in a part of the bed, whatever the form of the cells."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bedchain.trajectory.grid import Grid

# points along each axis of a cell, and in all cells at most
SAMPLES, MOST_SAMPLES = 8, 4_000_000

Places = NDArray[Any]


def shares_inside(grid: Grid, inside: Callable[[Places, Places, Places], Places]) -> NDArray[np.float64]:
    """Share of each cell's volume that lies in a part of the bed, by points spread evenly in the cell.

    Parameters
    ----------
    grid : Grid
    inside : callable
        From places x, z, y [m] to bools.

    Returns
    -------
    (n_cells,) array
        [1], to the part of a cell that a point stands for: 1/8 of its length in most grids.
    """
    n_axes = 2 if grid.form == "boxes" and grid.layers == 1 else 3
    n = int(np.clip((MOST_SAMPLES / grid.n_cells) ** (1 / n_axes), 2, SAMPLES))
    along = [(np.arange(n) + 0.5) / n] * n_axes + [np.array([0.5])] * (3 - n_axes)
    points = np.stack(np.meshgrid(*along, indexing="ij"), axis=-1).reshape(-1, 3)
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
