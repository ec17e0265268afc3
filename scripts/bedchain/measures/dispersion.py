# SPDX-License-Identifier: GPL-3.0-or-later
"""Drift and dispersion coefficients of the particles by height, from displacements."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import DataError
from bedchain.trajectory.frames import Lag


@dataclass(frozen=True)
class Dispersion:
    """Drift and dispersion of the particles that start in each layer of the bed.

    Parameters
    ----------
    height_m : (n_layers,) array
        Middle of each layer [m].
    displacements : (n_layers,) int64 array
        Number of displacements [1].
    drift_m_s : (n_layers, 2) array
        Mean velocity along x and z [m/s]; NaN in a layer without particles.
    dispersion_m2_s : (n_layers, 2) array
        Variance of the displacement over twice the lag, along x and z [m2/s].
    """

    height_m: NDArray[np.float64]
    displacements: NDArray[np.int64]
    drift_m_s: NDArray[np.float64]
    dispersion_m2_s: NDArray[np.float64]


def dispersion_by_height(
    x_m: NDArray[np.floating], z_m: NDArray[np.floating], edges_m: NDArray[np.float64], lag: Lag
) -> Dispersion:
    """Drift and dispersion coefficients of layers, from displacements over one lag.

    Parameters
    ----------
    x_m, z_m : (n_frames, n_particles) array
        Positions [m].
    edges_m : (n_layers + 1,) array
        Bounds of the layers, ascending [m]; particles outside them do not count.
    lag : Lag

    Returns
    -------
    Dispersion
        A displacement counts for the layer that it starts in.

    Raises
    ------
    DataError
        No displacement fits into the frames.
    """
    if not 1 <= lag.frames < len(x_m):
        raise DataError(
            f"{len(x_m)} frames hold no displacement over {lag.frames} frames: "
            "widen the window or cut the lag"
        )
    n_layers = len(edges_m) - 1
    number = np.zeros(n_layers + 2)
    sums, squares = np.zeros((2, n_layers + 2)), np.zeros((2, n_layers + 2))
    for frame in range(len(x_m) - lag.frames):
        layer = layer_of(np.asarray(z_m[frame], np.float64), edges_m)
        number += np.bincount(layer, minlength=n_layers + 2)
        for axis, position in enumerate((x_m, z_m)):
            step = np.subtract(position[frame + lag.frames], position[frame], dtype=np.float64)
            sums[axis] += np.bincount(layer, step, n_layers + 2)
            squares[axis] += np.bincount(layer, step**2, n_layers + 2)
    counts = np.where(number > 0, number, np.nan)[1:-1]
    mean = sums[:, 1:-1] / counts
    variance = np.maximum(squares[:, 1:-1] / counts - mean**2, 0.0)
    middle = 0.5 * (edges_m[:-1] + edges_m[1:])
    return Dispersion(
        middle, number[1:-1].astype(np.int64), (mean / lag.seconds).T, (variance / (2 * lag.seconds)).T
    )


def layer_of(z_m: NDArray[np.float64], edges_m: NDArray[np.float64]) -> NDArray[np.int64]:
    """Number of the layer of each position, as ``np.digitize`` gives it, five times as fast for equal layers.

    Parameters
    ----------
    z_m : (n_particles,) array
        [m].
    edges_m : (n_layers + 1,) array
        Bounds of layers of about one height, ascending [m].

    Returns
    -------
    (n_particles,) int64 array
        0 below the first bound, n_layers + 1 from the last one on.
    """
    n_layers = len(edges_m) - 1
    bounds = np.concatenate(([-np.inf], edges_m, [np.inf]))
    layer = ((z_m - edges_m[0]) * (n_layers / (edges_m[-1] - edges_m[0])) + 1).astype(np.int64)
    np.clip(layer, 0, n_layers + 1, out=layer)
    # the division is right but for round-off at a bound; layers of other heights take more rounds
    while (wrong := (z_m < bounds[layer]).astype(np.int64) - (z_m >= bounds[layer + 1])).any():
        layer -= wrong
    return layer
