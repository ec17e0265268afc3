# SPDX-License-Identifier: GPL-3.0-or-later
"""Synthetic frames for the chains: particles with a memory of their velocity in a small box."""

from dataclasses import replace

import numpy as np

from bedchain.trajectory.frames import Frames
from bedchain.trajectory.synthetic import persistent_walk

WIDTH, HEIGHT, DIAMETER = 0.04, 0.06, 1e-3  # [m]
MEMORY, SPEED = 0.1, 0.1  # of the velocity: time of its autocorrelation [s], spread along each axis [m/s]


def walkers(n_frames: int, n_particles: int, seed: int = 1, top: float = 1.0) -> Frames:
    """Frames of a persistent walk in the box; all cells are 0 (`synthetic.on_grid` gives them theirs).

    Parameters
    ----------
    n_frames, n_particles : int
    seed : int
    top : float
        Share of the height that they use.
    """
    return persistent_walk(n_frames, n_particles, (WIDTH, top * HEIGHT), MEMORY, SPEED, seed)


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
