# SPDX-License-Identifier: GPL-3.0-or-later
"""What a chain of cells adds to the spreading of particles: it forgets where in its cell a particle is.

Moved by d from a place anywhere in a cell of size h, a particle ends a whole number of cells further: the one
below d / h or the one above, with the probabilities 1 - f and f of the fraction f of d / h. That adds
h^2 f (1 - f) to the variance of each step, so h^2 E[f (1 - f)] / (2 tau) to the dispersion coefficient. What
the chain takes away is the memory of the velocity: over a lag tau the particles spread as <d^2> / (2 tau),
which still rises while the lag is shorter than the velocity is correlated.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import DataError
from bedchain.trajectory.frames import Lag
from bedchain.trajectory.grid import Grid

# displacements are seen from at most about so many frames, evenly spaced: enough for three digits
STARTS = 50


class Spreading(NamedTuple):
    """Dispersion coefficients over one lag, along x and z.

    Attributes
    ----------
    particles : (2,) ndarray
        Variance of the displacements over twice the lag [m2/s].
    cells : (2,) ndarray
        The same of the centres of the particles' cells, which is what the chain learns [m2/s].
    added : (2,) ndarray
        h^2 E[f (1 - f)] / (2 tau), by which the cells should exceed the particles [m2/s].
    """

    particles: NDArray[np.float64]
    cells: NDArray[np.float64]
    added: NDArray[np.float64]


def spreading(x_m: NDArray[np.floating], z_m: NDArray[np.floating], grid: Grid, lag: Lag) -> Spreading:
    """Dispersion of particles and of their cells, and the theory of the difference.

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
    found = np.empty((3, 2))
    for axis, (place, size) in enumerate(((x_m, grid.cell_width_m), (z_m, grid.cell_height_m))):
        moments = np.zeros(5)
        starts = range(0, len(place) - lag.frames, max(1, (len(place) - lag.frames) // STARTS))
        for frame in starts:
            now, later = (np.asarray(place[at], np.float64) / size for at in (frame, frame + lag.frames))
            step = later - now
            jump = np.floor(later) - np.floor(now)
            part = np.abs(step) % 1.0
            moments += (
                step.mean(),
                (step**2).mean(),
                jump.mean(),
                (jump**2).mean(),
                (part * (1 - part)).mean(),
            )
        moments /= len(starts)
        variances = moments[1] - moments[0] ** 2, moments[3] - moments[2] ** 2, moments[4]
        found[:, axis] = np.array(variances) * size**2 / (2 * lag.seconds)
    return Spreading(*found)
