# SPDX-License-Identifier: GPL-3.0-or-later
"""Particles as a LIGGGHTS data file, and frames of the checks' decks."""

import re

import numpy as np

from bedchain.dem.particle_files import read_frames, write_particles
from made.synthetic_bed import write_binary_dump

BOX = [(0, 0.1), (-1, 1), (0, 0.2)]


def test_a_data_file_holds_every_number_exactly(tmp_path):
    spheres = np.array([[0.1 / 3, 0.02, 0.5, -1e-17, 1e-3], [0.05, 0.06, 0.0, 0.25, 2e-3]])
    numbers = {"width": 0.1, "height": 0.2, "density": 2600.0, "diameter": 1e-3}
    write_particles(tmp_path / "particles.data", spheres, numbers)
    text = (tmp_path / "particles.data").read_text()
    assert "2 atoms\n" in text and "0 0.1 xlo xhi" in text and "0 0.2 zlo zhi" in text
    atoms = re.findall(r"^(\d+) 1 (\S+) 2600.0 (\S+) 0 (\S+)$", text, re.M)
    speeds = re.findall(r"^(\d+) (\S+) 0 (\S+) 0 0 0$", text, re.M)
    rows = [[*map(float, (x, z, vx, vz, d))] for (_, d, x, z), (_, vx, vz) in zip(atoms, speeds, strict=True)]
    assert rows == spheres.tolist()


def test_frames_come_by_step_and_particles_by_id(tmp_path):
    rng = np.random.default_rng(1)
    frames = rng.random((3, 4, 6))
    frames[:, :, 0] = [3, 1, 4, 2]
    # 90 sorts behind 100 and 1000 by name
    for step, frame in zip((90, 100, 1000), frames, strict=True):
        write_binary_dump(tmp_path / f"frame_{step}.bin", step, frame, BOX)
    found = read_frames(tmp_path)
    assert (found == frames[:, [1, 3, 0, 2]]).all()
