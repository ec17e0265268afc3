# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory of the motion at steps of a chain: none of a walk without memory, all of a straight motion."""

import numpy as np

from bedchain.measures.remaining_memory import remaining_memory
from bedchain.trajectory.synthetic import folded

# of a correlation of 20 000 pairs, three times its standard error
NOISE = 0.03


def test_a_walk_without_memory_in_a_box_has_none():
    rng = np.random.default_rng(1)
    steps = np.cumsum(rng.normal(0, 0.005, (2, 60, 1000)), axis=1) + rng.uniform(0, 0.1, (2, 1, 1000))
    places = np.stack([folded(axis, 0 * axis, 0.1)[0] for axis in steps])
    for lag in (1, 5, 20):
        assert np.abs(remaining_memory(places, lag)).max() < NOISE
    later, earlier = places[0, 40:] - places[0, 20:40], places[0, 20:40] - places[0, :20]
    assert np.corrcoef(later.ravel(), earlier.ravel())[0, 1] < -0.1  # the walls alone would pass for memory


def test_straight_motion_is_all_memory_and_none_is_zero():
    start, speed = np.random.default_rng(1).normal(0, 1, (2, 500))
    places = np.stack((100 * start + np.arange(10)[:, None] * speed, np.zeros((10, 500))))
    x, z = remaining_memory(places, 2)
    assert x > 0.9 and z == 0.0
