# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of many particles, fast enough for films: discs painted straight into an image."""

from collections.abc import Iterable, Iterator

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from bedchain.frames import Frames
from bedchain.grid import Grid
from bedchain.stationarity import profiles

# discs of neighbours touch at three pixels a diameter; more would make films larger and show nothing new
PIXELS_PER_DIAMETER = 3


class Canvas:
    """Picture of a bed in which every particle is a disc of its true size.

    Parameters
    ----------
    width_m, height_m : float
        What is shown [m].
    diameter_m : float
        Of a particle [m].
    colours : list of str
        Of particles that are marked, and of the others.
    """

    def __init__(self, width_m: float, height_m: float, diameter_m: float, colours: list[str]) -> None:
        self.size_m = (width_m, height_m)
        self.pixel_m = diameter_m / PIXELS_PER_DIAMETER
        self.shape = tuple(max(1, round(length / self.pixel_m)) for length in (height_m, width_m))
        self.colours = (255 * np.array([to_rgb(colour) for colour in colours])).astype(np.uint8)
        reach = PIXELS_PER_DIAMETER // 2
        rows, columns = np.mgrid[-reach : reach + 1, -reach : reach + 1]
        inside = rows**2 + columns**2 <= (PIXELS_PER_DIAMETER / 2) ** 2
        self.disc = rows[inside], columns[inside]

    def discs(
        self, x_m: NDArray[np.floating], z_m: NDArray[np.floating], marked: NDArray[np.bool_]
    ) -> NDArray[np.uint8]:
        """Paint particles.

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
        picture = np.full((*self.shape, 3), 255, np.uint8)
        colour = self.colours[np.where(marked, 0, 1)]
        row, column = (np.floor(np.asarray(place) / self.pixel_m).astype(int) for place in (z_m, x_m))
        for up, aside in zip(*self.disc, strict=True):
            at_row, at_column = row + up, column + aside
            seen = (at_row >= 0) & (at_row < self.shape[0]) & (at_column >= 0) & (at_column < self.shape[1])
            picture[at_row[seen], at_column[seen]] = colour[seen]
        return picture


def in_their_cells(
    paths: Iterable[NDArray[np.integer]], grid: Grid, shares: NDArray[np.float64]
) -> Iterator[tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Places of particles that only their cells are known of: each keeps its share of the way through a cell.

    Parameters
    ----------
    paths : iterable of (n_particles,) int array
        Cells.
    grid : Grid
    shares : (2, n_particles) array
        Along x and z, 0 to 1.

    Yields
    ------
    x_m, z_m : (n_particles,) array
        [m]
    """
    for cells in paths:
        row, column = np.divmod(cells, grid.columns)
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
    """Voidage of every lag-th frame, in cells that are about square.

    Parameters
    ----------
    frames : Frames
    lag : int
        Frames from one to the next.
    width_m, top_m : float
        What is looked at [m].
    cell_m, thickness_m, diameter_m : float
        Of a cell, of the slab, of a particle [m].

    Yields
    ------
    (rows, columns) array
        [1]; the first row is the lowest.
    """
    columns, rows = round(width_m / cell_m), max(1, round(top_m / cell_m))
    edges = np.linspace(0, width_m, columns + 1), np.linspace(0, top_m, rows + 1)
    for x, z in zip(frames.x_m[::lag], frames.z_m[::lag], strict=True):
        strip = np.clip(np.digitize(x, edges[0]) - 1, 0, columns - 1)
        yield np.stack(
            [
                profiles(z[None, strip == at], edges[1], width_m / columns, thickness_m, diameter_m)[0]
                for at in range(columns)
            ],
            axis=1,
        )
