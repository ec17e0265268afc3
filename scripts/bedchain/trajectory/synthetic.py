# SPDX-License-Identifier: GPL-3.0-or-later
"""Synthetic particles that move similarly to a bubbling bed, for benchmarks only."""

from pathlib import Path

import numpy as np
from numba import njit

from bedchain.files import write_npy_header
from bedchain.trajectory.grid import Grid

# The bed of the paper at rest, and motion that reaches about as many cells in 0.025 s as a simulation.
REST_HEIGHT_M = 0.35
BUBBLE_SPEED_M_S = 0.5
VELOCITY_SCATTER_M_S = 0.6
MEMORY = 0.85  # share of a particle's velocity that it keeps until the next frame
CIRCULATION_M_S = 0.25
PUSH_M_S = 0.5
BUBBLES = 6
YOUNG_RADIUS_M = 0.02
GROWTH_M_S = 0.1


@njit(cache=True)
def _advance(x, z, u, w, crowd, bubbles, time_s, step_s, width_m, height_m, rng):  # type: ignore[no-untyped-def]
    """Move all particles by one frame; crowd is the filling of each coarse cell, 1 for the bed at rest."""
    swing = CIRCULATION_M_S * np.cos(2.0 * np.pi * time_s / 1.3)
    for p in range(x.size):
        u[p] = MEMORY * u[p] + VELOCITY_SCATTER_M_S * (rng.random() - 0.5)
        w[p] = MEMORY * w[p] + VELOCITY_SCATTER_M_S * (rng.random() - 0.5)
        # circulation: up at one side, down at the other
        lift = swing * (1.0 - 2.0 * x[p] / width_m)
        drift = swing * (z[p] / REST_HEIGHT_M - 0.5) * 0.5
        for b in range(bubbles.shape[0]):
            dx, dz, radius = x[p] - bubbles[b, 0], z[p] - bubbles[b, 1], bubbles[b, 2]
            near = (dx * dx + dz * dz) / (radius * radius)
            if near < 4.0:
                # up inside the bubble, down around it, zero in the sum
                drift += BUBBLE_SPEED_M_S * dx / radius * (1.0 - 0.5 * near)
                lift += BUBBLE_SPEED_M_S * (1.0 - 0.5 * near)
        # particles leave crowded cells; gravity pulls them back to the height of the bed at rest
        row = int(z[p] / height_m * 0.999999 * crowd.shape[0])
        column = int(x[p] / width_m * 0.999999 * crowd.shape[1])
        below, above = crowd[max(row - 1, 0), column], crowd[min(row + 1, crowd.shape[0] - 1), column]
        before, after = crowd[row, max(column - 1, 0)], crowd[row, min(column + 1, crowd.shape[1] - 1)]
        drift += PUSH_M_S * (before - after)
        lift += PUSH_M_S * (below - above)
        if z[p] > REST_HEIGHT_M:
            lift -= 2.0 * (z[p] - REST_HEIGHT_M) / 0.1
        x[p] = abs(x[p] + step_s * (u[p] + drift))
        z[p] = abs(z[p] + step_s * (w[p] + lift))
        if x[p] > width_m:
            x[p] = max(2.0 * width_m - x[p], 0.0)
        if z[p] > height_m:
            z[p] = max(2.0 * height_m - z[p], 0.0)


def write_cells(
    path: Path,
    grid: Grid,
    n_particles: int,
    n_frames: int,
    seed: int,
    interval_s: float = 0.025,
    places: bool = False,
) -> None:
    """Write cells or positions of a synthetic bubbling bed, with one frame in memory at a time.

    Parameters
    ----------
    path : Path
        .npy to write, int32 (n_frames, n_particles), or float32 (n_frames, 2, n_particles) of positions [m].
    grid : Grid
        The cells.
    n_particles, n_frames : int
        Size of the trajectory [1].
    seed : int
        Seed of all random numbers.
    interval_s : float
        Time between frames [s].
    places : bool
        Write positions instead of cells.
    """
    rng = np.random.default_rng(seed)
    x, z = rng.random(n_particles) * grid.width_m, rng.random(n_particles) * min(REST_HEIGHT_M, grid.height_m)
    u, w = np.zeros(n_particles), np.zeros(n_particles)
    bubbles = rng.random((BUBBLES, 3)) * [grid.width_m, REST_HEIGHT_M, 0.0] + [0.0, 0.0, YOUNG_RADIUS_M]
    coarse = Grid(grid.width_m, grid.height_m, 9, 35)
    full = n_particles / (coarse.n_cells * REST_HEIGHT_M / grid.height_m)
    with path.open("wb") as stream:
        shape = (n_frames, 2, n_particles) if places else (n_frames, n_particles)
        write_npy_header(stream, shape, np.dtype("<f4" if places else "<i4"))
        for frame in range(n_frames):
            now = np.stack((x, z)).astype("<f4") if places else grid.cell_of(x, z).astype("<i4")
            stream.write(now.tobytes())
            crowd = np.bincount(coarse.cell_of(x, z), minlength=coarse.n_cells) / full
            crowd = crowd.reshape(coarse.rows, coarse.columns)
            _advance(
                x, z, u, w, crowd, bubbles, frame * interval_s, interval_s, grid.width_m, grid.height_m, rng
            )
            bubbles[:, 1] += BUBBLE_SPEED_M_S * interval_s
            bubbles[:, 2] += GROWTH_M_S * interval_s
            for burst in np.flatnonzero(bubbles[:, 1] > REST_HEIGHT_M):
                bubbles[burst] = rng.random() * grid.width_m, 0.0, YOUNG_RADIUS_M
