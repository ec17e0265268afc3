# SPDX-License-Identifier: GPL-3.0-or-later
"""Particles in LIGGGHTS data files, and in the dumps of the decks in liggghts_inputs/verify."""

from pathlib import Path
from typing import Any

import numpy as np

from bedchain.trajectory.dumps import read_dump

COLUMNS = ["id", "x", "z", "vx", "vz", "omegay"]


def write_particles(file: Path, particles: np.ndarray, parameters: dict[str, Any]) -> None:
    """Write spheres as a LIGGGHTS data file: one layer at y = 0 in the box of the case."""
    depth = 4 * parameters["diameter"]
    lines = ["spheres of a check", "", f"{len(particles)} atoms", "1 atom types", ""]
    lines += [f"0 {parameters['width']!r} xlo xhi", f"{-depth!r} {depth!r} ylo yhi"]
    lines += [f"0 {parameters['height']!r} zlo zhi", "", "Atoms", ""]
    rows = list(enumerate(particles.tolist(), start=1))
    lines += [f"{i} 1 {d!r} {parameters['density']!r} {x!r} 0 {z!r}" for i, (x, z, _, _, d) in rows]
    lines += ["", "Velocities", ""]
    lines += [f"{i} {vx!r} 0 {vz!r} 0 0 0" for i, (_, _, vx, vz, _) in rows]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def read_frames(folder: Path) -> np.ndarray:
    """All frames of a folder in the order of their steps, (n_frames, n_particles, 6)."""
    dumps = [read_dump(file, COLUMNS) for file in folder.glob("frame_*.bin")]
    frames = [
        dump.values[np.argsort(dump.values[:, 0])] for dump in sorted(dumps, key=lambda dump: dump.step)
    ]
    return np.array(frames)
