# SPDX-License-Identifier: GPL-3.0-or-later
"""Spreading of particles and of their cells, where both are known."""

import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.measures.numerical_dispersion import spreading
from bedchain.trajectory.frames import Lag
from bedchain.trajectory.grid import Grid

NUMBER = 40000
WIDTH, HEIGHT = 100.0, 100.0
# of a variance estimated from that many particles, and of a mean square a bit above it
SAMPLING = 0.03


def moved(steps_m, seed=1):
    """Two frames of particles, evenly spread to begin with, far from all walls."""
    rng = np.random.default_rng(seed)
    start = rng.uniform(40.0, 60.0, (2, NUMBER))
    return np.stack([start[0], start[0] + steps_m[0]]), np.stack([start[1], start[1] + steps_m[1]])


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 3.25])
def test_equal_steps_spread_cells_as_theory_says(share):
    grid = Grid(WIDTH, HEIGHT, 100, 50)
    found = spreading(*moved((share * 1.0, -share * 2.0)), grid, Lag(1, 0.1))
    part = share % 1
    np.testing.assert_allclose(found.particles, 0, atol=1e-9)
    np.testing.assert_allclose(found.added, np.array([1.0, 4.0]) * part * (1 - part) / 0.2, atol=1e-9)
    np.testing.assert_allclose(found.cells, found.added, rtol=SAMPLING, atol=1e-9)


def test_random_steps_spread_cells_by_as_much_more():
    rng = np.random.default_rng(2)
    steps = rng.normal(0, 0.7, (2, NUMBER))
    found = spreading(*moved(steps), Grid(WIDTH, HEIGHT, 100, 50), Lag(1, 0.1))
    np.testing.assert_allclose(found.particles, 0.49 / 0.2, rtol=SAMPLING)
    np.testing.assert_allclose(found.cells, found.particles + found.added, rtol=SAMPLING)
    # far longer steps than cells: any fraction, 1 / 6 on average; far shorter ones: the mean step
    fine = spreading(*moved(steps), Grid(WIDTH, HEIGHT, 1000, 1000), Lag(1, 0.1))
    np.testing.assert_allclose(fine.added, 0.1**2 / 6 / 0.2, rtol=SAMPLING)
    coarse = spreading(*moved(steps), Grid(WIDTH, HEIGHT, 1, 1), Lag(1, 0.1))
    np.testing.assert_allclose(coarse.added, 100 * 0.7 * np.sqrt(2 / np.pi) / 0.2, rtol=SAMPLING)


def test_a_drift_alone_spreads_no_particles():
    found = spreading(*moved((5.0, 5.0)), Grid(WIDTH, HEIGHT, 100, 100), Lag(1, 0.1))
    np.testing.assert_allclose(found.particles, 0, atol=1e-9)
    np.testing.assert_allclose(found.cells, 0, atol=1e-9)


def test_a_lag_longer_than_the_frames_is_refused():
    with pytest.raises(DataError, match="cut the lag"):
        spreading(*moved((0.0, 0.0)), Grid(WIDTH, HEIGHT, 10, 10), Lag(2, 0.1))
