# SPDX-License-Identifier: GPL-3.0-or-later
"""Synthetic frames for the chains: particles with a memory of their velocity in a small box."""

from dataclasses import replace

import numpy as np

from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid

WIDTH, HEIGHT, DIAMETER = 0.04, 0.06, 1e-3  # [m]
INTERVAL = 0.025  # [s]
MEMORY, SPEED = 0.8, 0.1  # of a velocity from frame to frame [1]; its spread along each axis [m/s]


def walkers(n_frames: int, n_particles: int, seed: int = 1, top: float = 1.0) -> Frames:
    """Frames of walkers that walls turn back; all cells are 0 (`on_grid` gives them theirs).

    Parameters
    ----------
    n_frames, n_particles : int
    seed : int
    top : float
        Share of the height that they use.
    """
    rng = np.random.default_rng(seed)
    axes = []
    for size in (WIDTH, top * HEIGHT):
        place, speed = rng.uniform(0, size, n_particles), rng.normal(0, SPEED, n_particles)
        frames = np.empty((2, n_frames, n_particles))
        for frame in range(n_frames):
            frames[:, frame] = place, speed
            moved = np.mod(place + INTERVAL * speed, 2 * size)
            back = moved > size
            place = np.where(back, 2 * size - moved, moved)
            kick = SPEED * np.sqrt(1 - MEMORY**2) * rng.normal(size=n_particles)
            speed = MEMORY * np.where(back, -speed, speed) + kick
        axes.append(frames)
    (x, vx), (z, vz) = axes
    times_s = INTERVAL * np.arange(n_frames, dtype=np.float64)
    return Frames(times_s, x, z, np.zeros(x.shape, np.int32), vx, vz)


def on_grid(frames: Frames, grid: Grid) -> Frames:
    """The same frames with the cells of a grid."""
    return replace(frames, cells=grid.cell_of(frames.x_m, frames.z_m))


def with_drain(frames: Frames) -> Frames:
    """Frames in which a particle that comes into the upper right corner stays there."""
    caught = np.logical_or.accumulate((frames.x_m > 0.75 * WIDTH) & (frames.z_m > 0.75 * HEIGHT), axis=0)
    when = np.argmax(caught, axis=0)[None]
    x, z = (
        np.where(caught, np.take_along_axis(np.asarray(places), when, axis=0), places)
        for places in (frames.x_m, frames.z_m)
    )
    assert frames.vx_m_s is not None and frames.vz_m_s is not None
    vx, vz = (np.where(caught, 0.0, speed) for speed in (frames.vx_m_s, frames.vz_m_s))
    return Frames(frames.times_s, x, z, frames.cells, vx, vz)


def lifted(frames: Frames, share: float) -> Frames:
    """Frames whose last one shows a share of the particles (at least one) at the top of the box."""
    z = np.array(frames.z_m)
    z[-1, : max(1, int(share * z.shape[1]))] = HEIGHT * (1 - 1e-3)
    return replace(frames, z_m=z)


def lifted_last(frames: Frames) -> Frames:
    """Frames whose last one shows a single particle at the top of the box."""
    return lifted(frames, 0.0)


def repeated(frames: Frames, times: int) -> Frames:
    """Frames with every particle ``times`` times, in single precision."""

    def tiled(values: np.ndarray | None) -> np.ndarray | None:
        return None if values is None else np.tile(np.asarray(values, np.float32), (1, times))

    x, z = tiled(frames.x_m), tiled(frames.z_m)
    assert x is not None and z is not None
    cells = np.tile(frames.cells, (1, times))
    return Frames(frames.times_s, x, z, cells, tiled(frames.vx_m_s), tiled(frames.vz_m_s))
