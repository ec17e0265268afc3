# SPDX-License-Identifier: GPL-3.0-or-later
"""Walkers against theory, and the bubbling bed of the benchmarks."""

import numpy as np
import pytest

from bedchain.trajectory.grid import Grid
from bedchain.trajectory.synthetic import INTERVAL_S, REST_HEIGHT_M, free_walk, persistent_walk, write_cells

GRID = Grid(0.27, 1.05, 9, 35)


def test_particles_stay_inside_move_and_are_the_same_for_the_same_seed(tmp_path):
    for name, seed, places in (("a", 1, False), ("b", 1, False), ("c", 2, False), ("places", 1, True)):
        write_cells(tmp_path / f"{name}.npy", GRID, 2000, 40, seed, places=places)
    cells, again, other, places = (np.load(tmp_path / f"{name}.npy") for name in ("a", "b", "c", "places"))
    assert (cells == again).all() and (cells != other).any()
    # positions in single precision may lie on the other side of an edge
    assert (GRID.cell_of(places[:, 0], places[:, 1]) == cells).mean() > 0.999
    # about as in a bed: 1 to 3 cells of 3 cm are reached in 0.025 s, and it does not blow away
    assert 0.05 < (cells[1:] != cells[:-1]).mean() < 0.6
    assert 0.5 * REST_HEIGHT_M < 2 * places[-1, 1].mean() < 1.5 * REST_HEIGHT_M


def test_free_walkers_spread_and_forget_as_theory_says():
    rng, memory_s, speed, number = np.random.default_rng(2), 0.1, 0.2, 40_000
    x, v = free_walk(rng.normal(0, speed, number), 13, memory_s, speed, rng)
    ratio = INTERVAL_S * np.arange(13) / memory_s
    spread = 2 * (speed * memory_s) ** 2 * (ratio - 1 + np.exp(-ratio))
    # a variance of 40 000 normal numbers is known to 0.7 %, a correlation to 0.5 %
    assert (x**2).mean(axis=1) == pytest.approx(spread, rel=0.03, abs=1e-12)
    assert (v * v[0]).mean(axis=1) / speed**2 == pytest.approx(np.exp(-ratio), abs=0.02)


def test_walls_turn_walkers_back():
    frames = persistent_walk(200, 300, (0.04, 0.06), 0.1, 0.5, seed=3)
    for places, speeds, size in ((frames.x_m, frames.vx_m_s, 0.04), (frames.z_m, frames.vz_m_s, 0.06)):
        assert places.min() >= 0 and places.max() <= size
        # spread evenly and as fast as without walls: three standard errors of 300 walkers, 50 memories each
        assert places.mean() / size == pytest.approx(0.5, abs=0.01)
        assert speeds.std() == pytest.approx(0.5, rel=0.02)
