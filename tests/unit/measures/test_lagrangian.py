# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.measures.lagrangian import Places, corrected, dispersion_error, in_cells, statistics
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.synthetic import free_walk
from made.frames import INTERVAL_S
from made.frames import squared_displacement as squared

MEMORY_S, SPEED, WALKERS = 0.15, 0.2, 20_000
STEPS, SPAN = np.array([0, 2, 4, 8, 16]), 4
# a variance of 20 000 walkers from 40 origins that are alike: two percent are four standard errors
SAMPLING = 0.02


@pytest.fixture(scope="module")
def walk():
    """Free walkers along x and z, lifted so that all heights are positive."""
    rng = np.random.default_rng(1)
    starts = (rng.normal(0, SPEED, WALKERS) for _ in range(2))
    x, z = (free_walk(v, 60, MEMORY_S, SPEED, rng)[0] for v in starts)
    return Places(x, z + 10.0, INTERVAL_S)


def test_displacements_of_a_persistent_walk_are_those_of_theory(walk):
    found = statistics(walk, STEPS, SPAN, np.array([0.0, 20.0]))
    theory = squared(STEPS * INTERVAL_S, MEMORY_S, SPEED)
    for axis in (0, 1):
        assert found.squared_m2.mean(axis=0)[:, axis] == pytest.approx(theory, rel=SAMPLING)
    assert found.dispersion_m2_s[0] == pytest.approx(theory[2] / (2 * SPAN * INTERVAL_S), rel=SAMPLING)


def test_autocorrelation_of_a_persistent_walk_is_that_of_theory(walk):
    found = statistics(walk, STEPS, SPAN, np.array([0.0, 20.0])).autocorrelation
    t, span = STEPS * INTERVAL_S, SPAN * INTERVAL_S
    # the mean product of two displacements is half the second difference of the mean-square displacement
    square = [squared(np.abs(t + shift), MEMORY_S, SPEED) for shift in (-span, 0, span)]
    theory = 0.5 * (square[0] - 2 * square[1] + square[2]) / squared(span, MEMORY_S, SPEED)
    for axis in (0, 1):
        assert found[:, axis] == pytest.approx(theory, abs=SAMPLING)


def test_statistics_are_those_of_naive_loops():
    rng = np.random.default_rng(2)
    x, z = rng.random((2, 9, 3))
    found = statistics(Places(x, z, 0.1), np.array([0, 3]), 2, np.array([0.0, 1.0]))
    last = 9 - 3 - 2
    square = np.mean([(x[t + 3, p] - x[t, p]) ** 2 for t in range(last) for p in range(3)])
    product = np.mean(
        [(x[t + 2, p] - x[t, p]) * (x[t + 5, p] - x[t + 3, p]) for t in range(last) for p in range(3)]
    )
    assert found.squared_m2.mean(axis=0)[1, 0] == pytest.approx(square)
    assert found.product_m2.mean(axis=0)[1, 0] == pytest.approx(product)
    assert found.span_s == pytest.approx(0.2)


def test_a_model_that_is_the_dem_has_no_error_whatever_its_cells(walk):
    grid = Grid(20.0, 20.0, 800, 800)  # 2.5 cm: about as long as a displacement
    cells = np.stack([grid.cell_of(x + 10, z) for x, z in zip(walk.x_m, walk.z_m, strict=True)])
    edges = np.linspace(9.0, 11.0, 5)
    dem = statistics(walk, STEPS, SPAN, edges)
    seen = statistics(in_cells(grid, cells, INTERVAL_S), STEPS, SPAN, edges)
    found = corrected(seen, dem, seen)
    assert seen.squared_m2.mean(axis=0)[1] == pytest.approx(
        dem.squared_m2.mean(axis=0)[1] + 0.025**2 / 6, rel=0.1
    )
    assert found.autocorrelation == pytest.approx(dem.autocorrelation, abs=1e-9)
    signed, rms = dispersion_error(found, dem)
    assert np.abs(signed).max() < 1e-9 and np.abs(rms).max() < 1e-9


def test_dispersion_error_by_hand():
    rng = np.random.default_rng(3)
    x, z = rng.random((2, 5, 4000))
    dem = statistics(Places(x, z, 0.1), np.array([0, 1]), 1, np.array([0.0, 0.5, 1.0]))
    model = corrected(dem, dem, dem)
    model.dispersion_m2_s[:] = dem.dispersion_m2_s * [1.5, 0.5]
    signed, rms = dispersion_error(model, dem)
    assert signed == pytest.approx([0.5, -0.5], rel=1e-9)
    assert rms[0] >= 0.5 and rms == pytest.approx([0.5, 0.5], rel=0.01)


def test_windows_too_short_are_refused():
    with pytest.raises(DataError, match="4 frames hold no displacements over 2 frames that start 3 frames"):
        statistics(Places(np.zeros((4, 2)), np.zeros((4, 2)), 0.1), np.array([0, 3]), 2, np.array([0.0, 1.0]))
