# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of made-up particles, shared by the tests of the chains."""

import numpy as np

from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import Realisation
from bedchain.trajectory.synthetic import INTERVAL_S, persistent_walk


def framed(cells: np.ndarray, grid: Grid) -> Frames:
    """Frames of particles in the middles of their cells."""
    x, z = np.moveaxis(grid.centres_m[cells], -1, 0)
    return Frames(np.arange(len(cells)) * INTERVAL_S, x, z, cells.astype(np.int32))


def hopping_cells(seed: int, n_frames: int = 30, n_particles: int = 200, n_cells: int = 12) -> np.ndarray:
    """Particles that hop to a neighbour, so that some cells fill and others stay almost empty."""
    rng = np.random.default_rng(seed)
    cells = np.empty((n_frames, n_particles), np.int32)
    cells[0] = rng.integers(0, n_cells // 2, n_particles)
    for frame in range(1, n_frames):
        cells[frame] = np.clip(cells[frame - 1] + rng.integers(-1, 2, n_particles), 0, n_cells - 1)
    return cells


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


def kept_velocity(
    n_particles: int, n_frames: int, width_m: float, memory_s: float, speed_m_s: float, seed: int
) -> Frames:
    """Walkers of the library in a square box."""
    return persistent_walk(n_frames, n_particles, (width_m, width_m), memory_s, speed_m_s, seed)


def walkers(intervals: int, n_particles: int = 200, seed: int = 5) -> Realisation:
    """A realisation of a bed of walkers that keep their velocity for 0.1 s, in a box of 0.1 m."""
    frames = kept_velocity(n_particles, intervals + 1, 0.1, 0.1, 0.2, seed)
    values = np.stack((frames.x_m, frames.z_m, frames.vx_m_s, frames.vz_m_s), axis=1).astype(np.float32)
    return Realisation(f"walkers {seed}", values, frames.times_s, 0.1, 0.1)


def squared_displacement(t_s: np.ndarray, memory_s: float, speed_m_s: float) -> np.ndarray:
    """Mean square of `synthetic.free_walk` [m2]."""
    return 2 * (speed_m_s * memory_s) ** 2 * (t_s / memory_s - 1 + np.exp(-t_s / memory_s))


def half_remaining(square_m2: np.ndarray, width_m: float) -> np.ndarray:
    """Share of one half's particles in that half, after displacements of a mean square folded at the walls.

    Cosines of odd order are what tells the halves apart, and a normal displacement damps each.
    """
    odd = np.arange(1, 400, 2)
    damped = np.exp(-np.multiply.outer(square_m2, (np.pi * odd / width_m) ** 2) / 2)
    return 0.5 + (4 / (np.pi * odd) ** 2 * damped).sum(axis=-1)
