# SPDX-License-Identifier: GPL-3.0-or-later
"""Particles whose velocity forgets itself exponentially: everything about them is known."""

import json

import numpy as np

INTERVAL_S = 0.025


def steps(n_frames, number, memory_s, speed, rng, substeps=10):
    """Positions and velocities of free Ornstein-Uhlenbeck walkers along one axis, (n_frames, number)."""
    keep = np.exp(-INTERVAL_S / substeps / memory_s)
    v = rng.normal(0, speed, number)
    x, frames = np.zeros(number), []
    for _ in range(n_frames):
        frames.append((x, v))
        for _ in range(substeps):
            new = keep * v + speed * np.sqrt(1 - keep**2) * rng.normal(size=number)
            x, v = x + 0.5 * (v + new) * INTERVAL_S / substeps, new
    return np.moveaxis(np.array(frames), 1, 0)


def squared(t, memory_s, speed):
    """Mean-square displacement of a free walker (Uhlenbeck and Ornstein 1930)."""
    return 2 * (speed * memory_s) ** 2 * (t / memory_s - 1 + np.exp(-t / memory_s))


def folded(x, v, upper):
    """Walkers between reflecting walls, from free ones: the position folded, the velocity turned."""
    phase = np.mod(x, 2 * upper)
    back = phase > upper
    return np.where(back, 2 * upper - phase, phase), np.where(back, -v, v)


def write_bed(folder, n_frames, number, size_m, memory_s, speed, seed):
    """trajectory.npy and trajectory.json of walkers in a square box; path of the first."""
    rng = np.random.default_rng(seed)
    rows = []
    for _ in range(2):
        x, v = steps(n_frames, number, memory_s, speed, rng)
        rows.append(folded(x + rng.uniform(0, size_m, number), v, size_m))
    (x, vx), (z, vz) = rows
    return write(folder, np.stack((x, z, vx, vz), axis=1), size_m)


def write(folder, values, size_m, first=0):
    """Values (n_frames, 4, number) as the pipeline stores them, from a frame on."""
    folder.mkdir(parents=True, exist_ok=True)
    values = values.astype(np.float32)
    values[:, :2] = np.clip(values[:, :2], 0, np.float32(size_m))
    np.save(folder / "trajectory.npy", values)
    metadata = {
        "times_s": [round((first + frame) * INTERVAL_S, 6) for frame in range(len(values))],
        "number": values.shape[2], "columns": ["x", "z", "vx", "vz"], "frame_interval_s": INTERVAL_S,
        "width_m": size_m, "height_m": size_m,
    }  # fmt: skip
    (folder / "trajectory.json").write_text(json.dumps(metadata))
    return folder / "trajectory.npy"
