# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of particles for films: discs painted directly into an image."""

from collections.abc import Iterable, Iterator

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from bedchain.measures.voidage import Slab, voidage_profiles
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid

# at three pixels the discs of touching particles touch; more pixels make films larger and show no more
PIXELS_PER_DIAMETER = 3


class Canvas:
    """Picture of a bed with every particle as a disc of its true size.

    Parameters
    ----------
    width_m, height_m : float
        Of the part of the bed that is shown [m].
    diameter_m : float
        Of a particle [m].
    colours : list of str
        Of the marked particles, and of the others.
    """

    def __init__(self, width_m: float, height_m: float, diameter_m: float, colours: list[str]) -> None:
        self.size_m = (width_m, height_m)
        self.pixel_m = diameter_m / PIXELS_PER_DIAMETER
        self.shape = tuple(max(1, round(length / self.pixel_m)) for length in (height_m, width_m))
        self.palette = (255 * np.array([to_rgb(colour) for colour in ("white", *colours)])).astype(np.uint8)
        self.reach = PIXELS_PER_DIAMETER // 2
        # a margin for discs whose centre is outside the picture
        self.margin = 2 * self.reach
        self.row_length = self.shape[1] + 2 * self.margin
        offsets = np.arange(-self.reach, self.reach + 1)
        rows, columns = np.meshgrid(offsets, offsets, indexing="ij")
        inside = rows**2 + columns**2 <= (PIXELS_PER_DIAMETER / 2) ** 2
        self.disc = (rows * self.row_length + columns)[inside]

    def discs(
        self, x_m: NDArray[np.floating], z_m: NDArray[np.floating], marked: NDArray[np.bool_]
    ) -> NDArray[np.uint8]:
        """Picture of particles.

        Parameters
        ----------
        x_m, z_m : (n_particles,) array
            Centres [m].
        marked : (n_particles,) bool array

        Returns
        -------
        (rows, columns, 3) uint8 array
            The first row is the lowest.
        """
        row, column = (np.floor(np.asarray(place) / self.pixel_m).astype(int) for place in (z_m, x_m))
        visible = (row >= -self.reach) & (row < self.shape[0] + self.reach)
        visible &= (column >= -self.reach) & (column < self.shape[1] + self.reach)
        centre = ((row + self.margin) * self.row_length + column + self.margin)[visible]
        colour = np.where(marked[visible], 1, 2).astype(np.uint8)
        picture = np.zeros((self.shape[0] + 2 * self.margin, self.row_length), np.uint8)
        for pixel in self.disc:
            picture.ravel()[centre + pixel] = colour
        return self.palette[picture[self.margin :, self.margin :][: self.shape[0], : self.shape[1]]]


def in_their_cells(
    paths: Iterable[NDArray[np.integer]], grid: Grid, shares: NDArray[np.float64]
) -> Iterator[tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Positions of particles whose cells alone are known; each keeps its relative position in its cells.

    Parameters
    ----------
    paths : iterable of (n_particles,) int array
        Cells.
    grid : Grid
    shares : (2, n_particles) array
        Relative positions along x and z, 0 to 1 [1].

    Yields
    ------
    x_m, z_m : (n_particles,) array
        [m]
    """
    for cells in paths:
        column, row, _ = grid.indices(cells)
        yield (column + shares[0]) * grid.cell_width_m, (row + shares[1]) * grid.cell_height_m


def voidages(
    frames: Frames,
    lag: int,
    width_m: float,
    top_m: float,
    cell_m: float,
    thickness_m: float,
    diameter_m: float,
) -> Iterator[NDArray[np.float64]]:
    """Voidage of every lag-th frame, in nearly square cells.

    Parameters
    ----------
    frames : Frames
    lag : int
        Frames between two that are shown [1].
    width_m, top_m : float
        Of the part of the bed that is shown [m].
    cell_m, thickness_m, diameter_m : float
        Of a cell, of the slab, of a particle [m].

    Yields
    ------
    (rows, columns) array
        [1]; the first row is the lowest.
    """
    columns, rows = round(width_m / cell_m), max(1, round(top_m / cell_m))
    edges = np.linspace(0, width_m, columns + 1), np.linspace(0, top_m, rows + 1)
    width, slab = width_m / columns, Slab(thickness_m, diameter_m)
    for x, z in zip(frames.x_m[::lag], frames.z_m[::lag], strict=True):
        strip = np.clip(np.digitize(x, edges[0]) - 1, 0, columns - 1)
        strips = [voidage_profiles(z[None, strip == at], edges[1], width, slab)[0] for at in range(columns)]
        yield np.stack(strips, axis=1)
