# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of made-up particles, shared by the tests of the chains."""

import numpy as np

from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import Realisation

INTERVAL_S = 0.025


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


def free_walk(
    velocity: np.ndarray, n_frames: int, memory_s: float, speed_m_s: float, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Positions along one axis, from 0 on, and velocities that forget themselves exponentially.

    Ornstein and Uhlenbeck 1930: both are exact at the frames, 0.025 s apart; (n_frames, n_particles) each.
    """
    keep = np.exp(-INTERVAL_S / memory_s)
    # A step's change of velocity and displacement are two correlated normal numbers.
    a, b = INTERVAL_S / memory_s, 1 - keep
    both = np.array(
        [[1 - keep**2, memory_s * b**2], [memory_s * b**2, memory_s**2 * (2 * a - 4 * b + 1 - keep**2)]]
    )
    root = np.linalg.cholesky(both) * speed_m_s
    x, v, frames = np.zeros(velocity.size), velocity, np.empty((2, n_frames, velocity.size))
    for frame in range(n_frames):
        frames[:, frame] = x, v
        kick = root @ rng.normal(size=(2, velocity.size))
        x, v = x + memory_s * b * v + kick[1], keep * v + kick[0]
    return frames[0], frames[1]


def folded(x: np.ndarray, v: np.ndarray, upper: float) -> tuple[np.ndarray, np.ndarray]:
    """Walkers between walls at 0 and ``upper``: the position mirrored back, the velocity turned."""
    phase = np.mod(x, 2 * upper)
    back = phase > upper
    return np.where(back, 2 * upper - phase, phase), np.where(back, -v, v)


def kept_velocity(
    n_particles: int, n_frames: int, width_m: float, memory_s: float, speed_m_s: float, seed: int
) -> Frames:
    """Particles of `free_walk` in a square box whose walls turn them back."""
    rng, axes = np.random.default_rng(seed), []
    for _ in range(2):
        v, start = rng.normal(0, speed_m_s, n_particles), rng.uniform(0, width_m, n_particles)
        x, v = free_walk(v, n_frames, memory_s, speed_m_s, rng)
        axes.append(folded(start + x, v, width_m))
    (x, vx), (z, vz) = axes
    return Frames(np.arange(n_frames) * INTERVAL_S, x, z, np.zeros(x.shape, np.int32), vx, vz)


def walkers(intervals: int, n_particles: int = 200, seed: int = 5) -> Realisation:
    """A realisation of a bed of walkers that keep their velocity for 0.1 s, in a box of 0.1 m."""
    frames = kept_velocity(n_particles, intervals + 1, 0.1, 0.1, 0.2, seed)
    values = np.stack((frames.x_m, frames.z_m, frames.vx_m_s, frames.vz_m_s), axis=1).astype(np.float32)
    return Realisation(f"walkers {seed}", values, frames.times_s, 0.1, 0.1)


def on_grid(frames: Frames, grid: Grid) -> Frames:
    """The same frames with cells of another grid."""
    cells = grid.cell_of(frames.x_m, frames.z_m)
    return Frames(frames.times_s, frames.x_m, frames.z_m, cells, frames.vx_m_s, frames.vz_m_s)


def squared_displacement(t_s: np.ndarray, memory_s: float, speed_m_s: float) -> np.ndarray:
    """Mean square of `free_walk` [m2]."""
    return 2 * (speed_m_s * memory_s) ** 2 * (t_s / memory_s - 1 + np.exp(-t_s / memory_s))


def half_remaining(square_m2: np.ndarray, width_m: float) -> np.ndarray:
    """Share of one half's particles in that half, after displacements of a mean square folded at the walls.

    Cosines of odd order are what tells the halves apart, and a normal displacement damps each.
    """
    odd = np.arange(1, 400, 2)
    damped = np.exp(-np.multiply.outer(square_m2, (np.pi * odd / width_m) ** 2) / 2)
    return 0.5 + (4 / (np.pi * odd) ** 2 * damped).sum(axis=-1)
