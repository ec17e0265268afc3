# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties of particles, with and without types and radii, and a file of something else."""

import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.files import write_arrays
from bedchain.trajectory.particles import Particles, read_particles, write_particles


def test_properties_come_back_as_far_as_they_are_there(tmp_path):
    trajectory, file = tmp_path / "trajectory.npy", tmp_path / "particles.npz"
    assert read_particles(trajectory) is None
    write_particles(file, Particles(np.array([3, 7]), radius_m=np.float32([1e-3, 2e-3])))
    particles = read_particles(trajectory)
    assert particles.ids.tolist() == [3, 7] and particles.type is None
    assert particles.radius_m.tolist() == np.float32([1e-3, 2e-3]).tolist()


def test_a_file_of_something_else_is_refused(tmp_path):
    write_arrays(tmp_path / "particles.npz", {"mass": np.ones(3)})
    with pytest.raises(DataError, match="particles.npz holds no properties of particles"):
        read_particles(tmp_path / "trajectory.npy")
