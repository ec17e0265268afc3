# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of made-up particles, shared by the tests of the chains."""

import numpy as np

from bedchain.frames import Frames
from bedchain.grid import Grid


def framed(cells: np.ndarray, grid: Grid) -> Frames:
    """Frames of particles in the middles of their cells."""
    x, z = np.moveaxis(grid.centres_m[cells], -1, 0)
    return Frames(np.arange(len(cells)) * 0.025, x, z, cells.astype(np.int32))


def stirred(seed: int = 0, n_frames: int = 60, n_particles: int = 400) -> tuple[Frames, Grid]:
    """Particles with a memory of their direction on a small bed."""
    rng = np.random.default_rng(seed)
    grid = Grid(0.05, 0.08, 5, 8)
    x, z = rng.random((2, n_particles)) * [[0.05], [0.08]]
    vx, vz = rng.normal(0, 0.004, (2, n_particles))
    frames = []
    for _ in range(n_frames):
        frames.append((x, z))
        vx, vz = 0.8 * vx + rng.normal(0, 0.003, n_particles), 0.8 * vz + rng.normal(0, 0.003, n_particles)
        x, z = np.clip(x + vx, 0, 0.05), np.clip(z + vz, 0, 0.08)
    x, z = np.moveaxis(np.array(frames), 1, 0)
    return Frames(np.arange(n_frames) * 0.025, x, z, grid.cell_of(x, z)), grid
