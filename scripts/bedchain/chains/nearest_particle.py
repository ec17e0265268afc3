# SPDX-License-Identifier: GPL-3.0-or-later
"""Search for the particle nearest to each tracer, in rings of buckets around it."""

import numpy as np
from numba import njit
from numpy.typing import NDArray


def nearest(
    tracers: NDArray[np.float64], particles: NDArray[np.floating], size_m: NDArray[np.float64]
) -> NDArray[np.int32]:
    """Number of the particle nearest to each tracer.

    Five times as fast as a k-d tree that is built for a single search.

    Parameters
    ----------
    tracers : (2, n_tracers) array
        Positions inside the bed [m].
    particles : (2, n_particles) array
        Positions inside the bed, at least one [m].
    size_m : (2,) array
        Size of the bed [m].

    Returns
    -------
    (n_tracers,) int32 array
    """
    side = float(np.sqrt(size_m[0] * size_m[1] / particles.shape[1]))
    shape = np.maximum(np.ceil(size_m / side), 1).astype(np.int64)
    first, order = _sorted(particles, side, shape)
    closest = np.empty(tracers.shape[1], np.int32)
    _search(tracers, particles, side, shape, first, order, _gaps(first, shape), closest)
    return closest


@njit(cache=True)
def _bucket(place, side, shape):  # type: ignore[no-untyped-def]
    return min(int(place / side), shape - 1)


@njit(cache=True)
def _sorted(particles, side, shape):  # type: ignore[no-untyped-def]
    """First entry of each bucket in the order of the particles by bucket, and that order."""
    first = np.zeros(shape[0] * shape[1] + 1, np.int64)
    bucket = np.empty(particles.shape[1], np.int64)
    for p in range(particles.shape[1]):
        column = _bucket(particles[0, p], side, shape[0])
        bucket[p] = _bucket(particles[1, p], side, shape[1]) * shape[0] + column
        first[bucket[p] + 1] += 1
    for b in range(first.size - 1):
        first[b + 1] += first[b]
    free, order = first[:-1].copy(), np.empty(particles.shape[1], np.int32)
    for p in range(particles.shape[1]):
        order[free[bucket[p]]] = p
        free[bucket[p]] += 1
    return first, order


@njit(cache=True)
def _gaps(first, shape):  # type: ignore[no-untyped-def]
    """Rings between each bucket and the nearest bucket with a particle; 0 for buckets with particles."""
    columns, rows = shape
    gaps = np.empty((rows, columns), np.int64)
    for b in range(rows * columns):  # a loop: numba's np.diff takes five seconds to compile
        gaps[b // columns, b % columns] = 0 if first[b + 1] > first[b] else columns + rows
    # Two sweeps, from the bottom left and from the top right, each over four of the eight neighbours.
    for turn in (1, -1):
        for i in range(rows):
            r = i if turn == 1 else rows - 1 - i
            for j in range(columns):
                c = j if turn == 1 else columns - 1 - j
                for down, aside in ((0, -1), (-1, -1), (-1, 0), (-1, 1)):
                    behind, beside = r + turn * down, c + turn * aside
                    if 0 <= behind < rows and 0 <= beside < columns:
                        gaps[r, c] = min(gaps[r, c], gaps[behind, beside] + 1)
    return gaps


@njit(cache=True)
def _search(tracers, particles, side, shape, first, order, gaps, closest):  # type: ignore[no-untyped-def]
    for t in range(tracers.shape[1]):
        x, z = tracers[0, t], tracers[1, t]
        column, row = _bucket(x, side, shape[0]), _bucket(z, side, shape[1])
        best, ring = np.inf, gaps[row, column]
        # Particles outside the searched rings are further away than ring - 1 buckets.
        while best > ((ring - 1) * side) ** 2:
            for r in range(max(row - ring, 0), min(row + ring, shape[1] - 1) + 1):
                # Whole rows at the ring's bottom and top, the two end buckets of the rows between them.
                step = 1 if abs(r - row) == ring else max(2 * ring, 1)
                for c in range(column - ring, column + ring + 1, step):
                    if c < 0 or c >= shape[0]:
                        continue
                    for entry in range(first[r * shape[0] + c], first[r * shape[0] + c + 1]):
                        p = order[entry]
                        away = (particles[0, p] - x) ** 2 + (particles[1, p] - z) ** 2
                        if away < best:
                            best, closest[t] = away, p
            ring += 1
