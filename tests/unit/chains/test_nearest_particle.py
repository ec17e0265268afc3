# SPDX-License-Identifier: GPL-3.0-or-later
"""The nearest particle, against a tree."""

import numpy as np
import pytest
from scipy.spatial import KDTree

from bedchain.chains.nearest_particle import nearest


@pytest.mark.parametrize("count", [1, 3, 200])
def test_the_nearest_particle_is_that_of_a_tree(count):
    rng, size = np.random.default_rng(count), np.array([0.1, 0.4])
    for height in (0.4, 0.05):
        particles = rng.random((2, count)) * [[0.1], [height]]
        tracers = np.concatenate((rng.random((2, 500)), [[0, 1, 0, 1], [0, 0, 1, 1]]), axis=1) * size[:, None]
        for dtype in (np.float64, np.float32):
            held = particles.astype(dtype)
            away = KDTree(held.T.astype(float)).query(tracers.T)[0]
            found = nearest(tracers, held, size)
            assert np.hypot(*(held[:, found] - tracers)) == pytest.approx(away, abs=1e-9)
