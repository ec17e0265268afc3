# SPDX-License-Identifier: GPL-3.0-or-later
"""Voidage of a one-layer bed by height and in cells."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bedchain.trajectory.grid import Grid


@dataclass(frozen=True)
class Slab:
    """A slab of equal spheres.

    Attributes
    ----------
    thickness_m, diameter_m : float
        Thickness of the slab, diameter of the spheres [m].
    """

    thickness_m: float
    diameter_m: float


def voidage_profiles(
    z_m: NDArray[np.floating],
    edges_m: NDArray[np.float64],
    width_m: float,
    slab: Slab,
) -> NDArray[np.float64]:
    """Voidage by height in each frame, 1 - (sphere volume) / (width dz T).

    Parameters
    ----------
    z_m : (n_frames, n_particles) array
        Heights [m].
    edges_m : (n_rows + 1,) array
        Edges of the rows [m].
    width_m : float
        Of the bed [m].
    slab : Slab

    Returns
    -------
    (n_frames, n_rows) ndarray
        Voidage [1].
    """
    held = np.array([np.histogram(z, edges_m)[0] for z in z_m])
    volume = np.pi / 6 * slab.diameter_m**3
    return np.asarray(1 - held * volume / (width_m * np.diff(edges_m) * slab.thickness_m))


def cell_voidage(
    x_m: NDArray[np.floating], z_m: NDArray[np.floating], grid: Grid, slab: Slab
) -> NDArray[np.float64]:
    """Voidage of the cells in a frame, by the particles whose centres a cell holds, (n_cells,) [1].

    Parameters
    ----------
    x_m, z_m : (n_particles,) array
        Positions [m].
    grid : Grid
    slab : Slab
    """
    solids = np.pi / 6 * slab.diameter_m**3 / (grid.cell_width_m * grid.cell_height_m * slab.thickness_m)
    return np.asarray(1 - solids * np.bincount(grid.cell_of(x_m, z_m), minlength=grid.n_cells), np.float64)
