# SPDX-License-Identifier: GPL-3.0-or-later
"""Numerical dispersion of a chain of cells, which forgets the position of a particle in its cell.

A particle that moves by d from a random position in a cell of size h crosses a whole number of cells: d / h
rounded down or up, with the probabilities 1 - f and f, where f is the fraction of d / h. That adds
h^2 f (1 - f) to the variance of each step, so h^2 E[f (1 - f)] / (2 tau) to the dispersion coefficient. In
return the chain loses the memory of the velocity: over a lag tau the particles spread as <d^2> / (2 tau),
which still rises while the lag is shorter than the correlation time of the velocity.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import DataError
from bedchain.trajectory.frames import Lag
from bedchain.trajectory.grid import Grid

# frames, evenly spaced, at which displacements start: enough for three digits
STARTS = 50


class Spreading(NamedTuple):
    """Dispersion coefficients over one lag, along x and z.

    Attributes
    ----------
    particles : (2,) ndarray
        Variance of the displacements over twice the lag [m2/s].
    cells : (2,) ndarray
        The same of the centres of the particles' cells, from which the chain learns [m2/s].
    added : (2,) ndarray
        h^2 E[f (1 - f)] / (2 tau), the excess of the cells in theory [m2/s].
    """

    particles: NDArray[np.float64]
    cells: NDArray[np.float64]
    added: NDArray[np.float64]


def spreading(x_m: NDArray[np.floating], z_m: NDArray[np.floating], grid: Grid, lag: Lag) -> Spreading:
    """Dispersion of particles and of their cells, and the difference in theory.

    Parameters
    ----------
    x_m, z_m : (n_frames, n_particles) array
        Positions [m].
    grid : Grid
    lag : Lag

    Returns
    -------
    Spreading

    Raises
    ------
    DataError
        No displacement fits into the frames.
    """
    if not 1 <= lag.frames < len(x_m):
        raise DataError(f"{len(x_m)} frames hold no displacement over {lag.frames} frames: cut the lag")
    coefficients = np.empty((3, 2))
    for axis, (place, size) in enumerate(((x_m, grid.cell_width_m), (z_m, grid.cell_height_m))):
        moments = np.zeros(5)
        starts = range(0, len(place) - lag.frames, max(1, (len(place) - lag.frames) // STARTS))
        for frame in starts:
            now, later = (np.asarray(place[at], np.float64) / size for at in (frame, frame + lag.frames))
            step = later - now
            jump = np.floor(later) - np.floor(now)
            part = np.abs(step)
            part -= np.floor(part)  # exact, at a fifth of the time of a remainder
            moments += (
                step.mean(),
                (step**2).mean(),
                jump.mean(),
                (jump**2).mean(),
                (part * (1 - part)).mean(),
            )
        moments /= len(starts)
        variances = moments[1] - moments[0] ** 2, moments[3] - moments[2] ** 2, moments[4]
        coefficients[:, axis] = np.array(variances) * size**2 / (2 * lag.seconds)
    return Spreading(*coefficients)


def added_share(place_m: NDArray[np.floating], size_m: float, lag: int) -> float:
    """Dispersion that cells add along one axis in theory, over that of the particles.

    Parameters
    ----------
    place_m : (n_frames, n_particles) array
        Positions along the axis [m].
    size_m : float
        Of a cell [m].
    lag : int
        [frames].

    Returns
    -------
    float
        h^2 E[f (1 - f)] / var(displacement) [1]; 0 where nothing moves.
    """
    starts = np.arange(0, len(place_m) - lag, max(1, (len(place_m) - lag) // STARTS))
    steps = np.subtract(place_m[starts + lag], place_m[starts], dtype=np.float64)
    variance = float(steps.var())
    part = np.abs(steps) / size_m % 1.0
    return size_m**2 * float((part * (1 - part)).mean()) / variance if variance > 0 else 0.0
