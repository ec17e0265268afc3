# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells, packing limit and start of a two-fluid run."""

import math

import numpy as np
from numpy.typing import NDArray

from bedchain.case.schema import Case
from bedchain.physics.packing import PACKED_AREA_SHARE, slab_voidage
from bedchain.trajectory.grid import Grid

CLOSEST_AREA_SHARE = math.pi / (2 * math.sqrt(3))  # of the plane: closest discs
UNEVEN = ((0.05, 1, 0.7), (0.03, 5, 1.3))  # surface at the start: amplitude, half waves, phase


def grid_of(case: Case) -> Grid:
    """Cells of a two-fluid run: the gas cells of the case."""
    bed, cell_m = case["bed"], case["gas"]["cell_size_m"]
    columns, rows = (round(bed[name] / cell_m) for name in ("width_m", "height_m"))
    return Grid(bed["width_m"], bed["height_m"], columns, rows)


def largest_solids(case: Case) -> float:
    """Share of the solids that none exceeds [1]: closest discs in the slab, three digits."""
    thickness = case["bed"]["thickness_m"] / case["particles"]["diameter_m"]
    return round(1 - slab_voidage(CLOSEST_AREA_SHARE, thickness), 3)


def start_solids(case: Case) -> NDArray[np.float64]:
    """Share of the solids at the start, (rows, columns): a settled bed with an uneven surface [1]."""
    grid, bed, particles = grid_of(case), case["bed"], case["particles"]
    settled = 1 - slab_voidage(PACKED_AREA_SHARE, bed["thickness_m"] / particles["diameter_m"])
    volume = particles["number"] * math.pi / 6 * particles["diameter_m"] ** 3
    height = volume / (settled * bed["width_m"] * bed["thickness_m"])
    x = (np.arange(grid.columns) + 0.5) / grid.columns
    surface = np.ones(grid.columns)
    for size, waves, phase in UNEVEN:
        surface += size * np.sin(math.pi * waves * x + phase)
    surface = surface * height / surface.mean()
    low = grid.cell_height_m * np.arange(grid.rows)[:, None]
    return settled * np.clip((surface - low) / grid.cell_height_m, 0, 1)


def field_text(values: NDArray[np.float64]) -> str:
    """Values of cells as the entry ``internalField`` of OpenFOAM."""
    numbers = "\n".join(f"{value:.12g}" for value in values.ravel())
    return f"internalField nonuniform List<scalar> {values.size}\n(\n{numbers}\n);\n"
