# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of particles and of cells for films, painted directly into an image."""

from collections.abc import Iterable, Iterator

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from bedchain.measures.voidage import Slab, cell_voidage
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid

Places = tuple[NDArray[np.floating], NDArray[np.floating]]

# at four pixels a disc is round
MOST_PIXELS_PER_DIAMETER = 4
# a disc of one pixel would lose its colour, which a film stores for every second pixel only
LEAST_PIXELS_OF_DISC = 2
# of the bed: with the axes about a screen; more rows make the film larger and show no more
MOST_ROWS = 1000
# of all panels: most players end at 4096 pixels
MOST_COLUMNS = 3600
LEVELS = 256


def pixel_size(width_m: float, height_m: float, diameter_m: float, panels: int) -> float:
    """Size of the pixels in which a bed is painted [m].

    Parameters
    ----------
    width_m, height_m : float
        Of the part of the bed that is shown [m].
    diameter_m : float
        Of a particle [m].
    panels : int
        Pictures side by side [1].
    """
    return max(diameter_m / MOST_PIXELS_PER_DIAMETER, height_m / MOST_ROWS, panels * width_m / MOST_COLUMNS)


class Canvas:
    """Pictures of a bed: particles as discs of their true size but at least two pixels wide, values of cells.

    The first row of a picture is the lowest.

    Parameters
    ----------
    width_m, height_m : float
        Of the part of the bed that is shown [m].
    diameter_m : float
        Of a particle [m].
    pixel_m : float
        Size of a pixel [m].
    colours : list of str
        Of the marked particles, and of the others.
    """

    def __init__(
        self, width_m: float, height_m: float, diameter_m: float, pixel_m: float, colours: list[str]
    ) -> None:
        self.size_m = (width_m, height_m)
        self.pixel_m = pixel_m
        self.shape = tuple(max(1, round(length / pixel_m)) for length in (height_m, width_m))
        self.palette = (255 * np.array([to_rgb(colour) for colour in ("white", *colours)])).astype(np.uint8)
        self.reach = max(LEAST_PIXELS_OF_DISC, round(diameter_m / pixel_m))
        # a margin for discs whose centre is outside the picture
        self.row_length = self.shape[1] + 2 * self.reach
        rows, columns = np.indices((self.reach, self.reach))
        middle = (self.reach - 1) / 2
        inside = (rows - middle) ** 2 + (columns - middle) ** 2 <= (self.reach / 2) ** 2
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
        """
        row, column = (
            np.round(np.asarray(place) / self.pixel_m + self.reach / 2).astype(int) for place in (z_m, x_m)
        )
        visible = (row >= 0) & (row <= self.shape[0] + self.reach)
        visible &= (column >= 0) & (column <= self.shape[1] + self.reach)
        first = (row * self.row_length + column)[visible]
        colour = np.where(marked[visible], 1, 2).astype(np.uint8)
        picture = np.zeros((self.shape[0] + 2 * self.reach + 1, self.row_length), np.uint8)
        for pixel in self.disc:
            picture.ravel()[first + pixel] = colour
        return np.take(self.palette, self._inside(picture), axis=0)  # a third of the time of an index

    def _inside(self, picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
        return picture[self.reach :, self.reach :][: self.shape[0], : self.shape[1]]

    def cells(
        self, values: NDArray[np.float64], grid: Grid, limits: tuple[float, float], colour_map: str
    ) -> NDArray[np.uint8]:
        """Picture of the values of cells.

        Parameters
        ----------
        values : (n_cells,) array
        grid : Grid
        limits : (float, float)
            Values of the first and of the last colour.
        colour_map : str
            Name in Matplotlib.

        Returns
        -------
        (rows, columns, 3) uint8 array
        """
        sizes = (grid.cell_height_m, grid.rows), (grid.cell_width_m, grid.columns)
        row, column = (
            np.minimum(((np.arange(pixels) + 0.5) * self.pixel_m / size).astype(int), number - 1)
            for pixels, (size, number) in zip(self.shape, sizes, strict=True)
        )
        share = np.clip((values - limits[0]) / (limits[1] - limits[0]), 0, 1)
        level = (share * (LEVELS - 1)).round().astype(np.uint8).reshape(grid.rows, grid.columns)
        colours = (255 * colormaps[colour_map](np.linspace(0, 1, LEVELS))[:, :3]).astype(np.uint8)
        return colours[level].take(column, axis=1).take(row, axis=0)  # whole rows last


def in_their_cells(
    paths: Iterable[NDArray[np.integer]], grid: Grid, shares: NDArray[np.float64]
) -> Iterator[Places]:
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


def at_film_steps(places: Iterator[Places], lag: int, film_lag: int, frames: int) -> Iterator[Places]:
    """The newest positions of a chain at each frame of a film: a chain of longer steps rests in between.

    Parameters
    ----------
    places : iterator of (x_m, z_m)
        At each step of the chain, from step 0 on.
    lag, film_lag : int
        A step of the chain, a step of the film, in frames of the DEM [1].
    frames : int
        Of the film [1].

    Yields
    ------
    x_m, z_m : (n_particles,) array
        [m]
    """
    step, newest = 0, next(places)
    for frame in range(frames):
        while step < frame * film_lag // lag:
            step, newest = step + 1, next(places)
        yield newest


def voidages(frames: Frames, lag: int, grid: Grid, slab: Slab) -> Iterator[NDArray[np.float64]]:
    """Voidage of every lag-th frame, by the particles whose centres a cell holds.

    Parameters
    ----------
    frames : Frames
    lag : int
        Frames between two that are shown [1].
    grid : Grid
    slab : Slab

    Yields
    ------
    (n_cells,) array
        [1]
    """
    for x, z in zip(frames.x_m[::lag], frames.z_m[::lag], strict=True):
        yield cell_voidage(x, z, grid, slab)
