# SPDX-License-Identifier: GPL-3.0-or-later
"""Lagrangian statistics of particles: mean-square displacement, autocorrelation, dispersion.

A chain knows the cell of a particle, not its position in the cell, so its particles are put at the cell
centres. The error of that is measured on the DEM, with its particles at their positions and at the centres of
the same cells, and subtracted from the statistics of the chain (`corrected`).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import DataError
from bedchain.measures.dispersion import dispersion_by_height
from bedchain.trajectory.frames import Lag
from bedchain.trajectory.grid import Grid

Array = NDArray[np.float64]

# origins of displacements: more are nearly the same, and cost time
MOST_ORIGINS = 40
# blocks of origins, from which error bars are drawn
BLOCKS = 5
# in a layer: a variance of fewer is too uncertain
FEWEST_DISPLACEMENTS = 100


@dataclass(frozen=True)
class Places:
    """Positions of the same particles in evenly spaced frames.

    Parameters
    ----------
    x_m, z_m : (n_frames, n_particles) array
        Positions [m].
    interval_s : float
        Time between two frames [s].
    """

    x_m: NDArray[np.floating]
    z_m: NDArray[np.floating]
    interval_s: float


@dataclass(frozen=True)
class Statistics:
    """Lagrangian statistics of positions, in at most `BLOCKS` blocks of origins.

    Parameters
    ----------
    times_s : (n_times,) array
        Time between the two ends of a displacement, or between the starts of two displacements [s].
    squared_m2 : (n_blocks, n_times, 2) array
        Mean-square displacement along x and z [m2].
    product_m2 : (n_blocks, n_times, 2) array
        Mean product of two displacements over ``span_s`` whose starts are that time apart [m2].
    span_s : float
        Duration of these displacements [s].
    dispersion_m2_s : (n_layers, 2) array
        Dispersion coefficient of each layer over ``span_s`` [m2/s].
    displacements : (n_layers,) array
        Number of displacements that start in each layer [1].
    """

    times_s: Array
    squared_m2: Array
    product_m2: Array
    span_s: float
    dispersion_m2_s: Array
    displacements: Array

    @property
    def autocorrelation(self) -> Array:
        """Displacement autocorrelation along x and z, (n_times, 2), over its value at time 0 [1]."""
        product = self.product_m2.mean(axis=0)
        return np.asarray(product / product[0])


def in_cells(grid: Grid, cells: NDArray[np.integer], interval_s: float) -> Places:
    """Particles at the centres of their cells, in single precision to save memory."""
    centres = grid.centres_m.astype(np.float32)
    return Places(centres[cells, 0], centres[cells, 1], interval_s)


def statistics(places: Places, steps: NDArray[np.integer], span: int, edges_m: Array) -> Statistics:
    """Lagrangian statistics of positions.

    Parameters
    ----------
    places : Places
    steps : (n_times,) int array
        Frames between the ends of a displacement, ascending from 0 [1].
    span : int
        Frames in the displacements of the autocorrelation and the dispersion [1].
    edges_m : (n_layers + 1,) array
        Bounds of the layers of the dispersion [m].

    Returns
    -------
    Statistics

    Raises
    ------
    DataError
        The frames are fewer than the longest time and the span together.
    """
    room = len(places.x_m) - int(steps[-1]) - span
    if room < 1:
        raise DataError(
            f"{len(places.x_m)} frames hold no displacements over {span} frames that start {steps[-1]} "
            "frames apart: widen the window"
        )
    origins = np.unique(np.linspace(0, room - 1, min(room, MOST_ORIGINS)).round().astype(int))
    squared, product = (np.empty((origins.size, steps.size, 2)) for _ in range(2))
    for axis, place in enumerate((places.x_m, places.z_m)):
        for row, origin in enumerate(origins):
            begin = place[origin].astype(float)
            first = place[origin + span] - begin
            for column, step in enumerate(steps):
                later = place[origin + step]
                squared[row, column, axis] = np.mean((later - begin) ** 2)
                product[row, column, axis] = np.mean(first * (place[origin + step + span] - later))
    span_s = span * places.interval_s
    dispersion = dispersion_by_height(places.x_m, places.z_m, edges_m, Lag(span, span_s))
    return Statistics(
        np.asarray(steps * places.interval_s, float),
        _by_block(squared),
        _by_block(product),
        span_s,
        dispersion.dispersion_m2_s,
        dispersion.displacements.astype(float),
    )


def corrected(model: Statistics, dem: Statistics, dem_in_cells: Statistics) -> Statistics:
    """Statistics of a chain less the error of cell centres, measured on the DEM.

    Parameters
    ----------
    model : Statistics
        Of the chain's particles, at the centres of their cells.
    dem, dem_in_cells : Statistics
        Of the DEM's particles at their positions, and at the centres of the same cells.

    Returns
    -------
    Statistics
    """
    squared, product = (
        (getattr(dem_in_cells, name).mean(axis=0) - getattr(dem, name).mean(axis=0))
        for name in ("squared_m2", "product_m2")
    )
    return Statistics(
        model.times_s,
        model.squared_m2 - squared,
        model.product_m2 - product,
        model.span_s,
        model.dispersion_m2_s - (dem_in_cells.dispersion_m2_s - dem.dispersion_m2_s),
        model.displacements,
    )


def dispersion_error(model: Statistics, dem: Statistics) -> tuple[Array, Array]:
    """Error of a chain's dispersion coefficients against the DEM's, over the layers.

    Returns
    -------
    signed, rms : (2,) array
        Mean and root mean square of the difference along x and z over the layers, weighted by the DEM's
        displacements, over the DEM's mean coefficient [1].
    """
    layers = (dem.displacements >= FEWEST_DISPLACEMENTS) & (model.displacements >= FEWEST_DISPLACEMENTS)
    weight = dem.displacements[layers, None] / dem.displacements[layers].sum()
    mean = (weight * dem.dispersion_m2_s[layers]).sum(axis=0)
    error = (model.dispersion_m2_s[layers] - dem.dispersion_m2_s[layers]) / mean
    return (weight * error).sum(axis=0), np.sqrt((weight * error**2).sum(axis=0))


def _by_block(by_origin: Array) -> Array:
    parts = np.array_split(by_origin, min(BLOCKS, len(by_origin)))
    return np.stack([part.mean(axis=0) for part in parts])
