# SPDX-License-Identifier: GPL-3.0-or-later
"""Drift and dispersion coefficients of the particles by height, from displacements."""

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from bedchain.errors import DataError
from bedchain.measures.dispersion_by_lag import BLOCKS
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
    left_out_m2_s : (BLOCKS, n_layers, 2) array
        The same of the displacements that start outside one of five equal blocks of the frames [m2/s].
    """

    height_m: NDArray[np.float64]
    displacements: NDArray[np.int64]
    drift_m_s: NDArray[np.float64]
    dispersion_m2_s: NDArray[np.float64]
    left_out_m2_s: NDArray[np.float64]


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
    moments = np.zeros((BLOCKS, 3, 2, n_layers + 2))  # number, sum and sum of squares
    edges, n_starts = np.asarray(edges_m, np.float64), len(x_m) - lag.frames
    for frame in range(n_starts):
        layer = layer_of(np.ascontiguousarray(z_m[frame], np.float64), edges)
        of_block = moments[frame * BLOCKS // n_starts]
        for axis, position in enumerate((x_m, z_m)):
            ends = position[frame], position[frame + lag.frames]
            now, later = (np.ascontiguousarray(end, np.float64) for end in ends)
            of_block[:, axis] += _moments(layer, now, later, n_layers)
    whole = moments.sum(axis=0)
    mean_m, variance_m2 = _mean_and_variance(whole)
    left_out_m2 = np.stack([_mean_and_variance(whole - of_block)[1] for of_block in moments])
    middle, twice_s = 0.5 * (edges_m[:-1] + edges_m[1:]), 2 * lag.seconds
    number = whole[0, 0, 1:-1].astype(np.int64)
    return Dispersion(middle, number, mean_m / lag.seconds, variance_m2 / twice_s, left_out_m2 / twice_s)


def _mean_and_variance(moments: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Of the displacements of each layer, (n_layers, 2), from (3, 2, n_layers + 2) moments."""
    number, total, square = moments[:, :, 1:-1]
    counts = np.where(number > 0, number, np.nan)
    mean = total / counts
    return mean.T, np.maximum(square / counts - mean**2, 0.0).T


@njit(cache=True)
def _moments(layer, now, later, n_layers):  # type: ignore[no-untyped-def]
    """Number, sum and sum of squares of the displacements of each layer, (3, n_layers + 2)."""
    moments = np.zeros((3, n_layers + 2))
    for particle in range(layer.size):
        place, step = layer[particle], later[particle] - now[particle]
        moments[0, place] += 1
        moments[1, place] += step
        moments[2, place] += step**2
    return moments


@njit(cache=True)
def layer_of(z_m, edges_m):  # type: ignore[no-untyped-def]
    """Number of the layer of each position, as ``np.digitize`` gives it, in a fraction of its time.

    Parameters
    ----------
    z_m : (n_particles,) float64 array
        [m].
    edges_m : (n_layers + 1,) float64 array
        Bounds of layers of about one height, ascending [m].

    Returns
    -------
    (n_particles,) int64 array
        0 below the first bound, n_layers + 1 from the last one on.
    """
    layers = np.empty(z_m.size, np.int64)
    n_layers = edges_m.size - 1
    per_m = n_layers / (edges_m[-1] - edges_m[0])
    for particle in range(z_m.size):
        z = z_m[particle]
        layer = 0
        if z >= edges_m[-1]:
            layer = n_layers + 1
        elif z >= edges_m[0]:
            layer = min(np.int64((z - edges_m[0]) * per_m) + 1, n_layers)
            # the division is right but for round-off at a bound; layers of other heights take more steps
            while z < edges_m[layer - 1]:
                layer -= 1
            while z >= edges_m[layer]:
                layer += 1
        layers[particle] = layer
    return layers
