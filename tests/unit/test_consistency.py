# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from scipy import sparse

from bedchain import chains
from bedchain.bootstrap import block_chains
from bedchain.consistency import chapman_kolmogorov, timescales_over_lags
from bedchain.dispersion import dispersion_by_height
from bedchain.frames import DataError, Frames
from bedchain.grid import Grid


def framed(cells: np.ndarray, grid: Grid) -> Frames:
    x, z = np.moveaxis(grid.centres_m[cells], -1, 0)
    return Frames(np.arange(len(cells)) * 0.025, x, z, cells)


def walk_frames(n_particles: int = 20_000, steps: int = 60) -> tuple[Frames, Grid]:
    """A chain that is Markov on its 4 x 3 cells."""
    rng = np.random.default_rng(1)
    grid = Grid(0.04, 0.03, 4, 3)
    dense = rng.random((12, 12)) ** 6 + np.eye(12)
    matrix = sparse.csr_array(dense / dense.sum(axis=1, keepdims=True))
    return framed(chains.simulate(matrix, rng.integers(0, 12, n_particles), steps, rng), grid), grid


def ballistic_frames() -> tuple[Frames, Grid]:
    """Particles to and fro along the width at constant speed, far from Markov on cells."""
    rng = np.random.default_rng(2)
    grid = Grid(0.1, 0.01, 10, 1)
    phase = rng.random(2000) * 20 + np.arange(60)[:, None] * 0.5
    cells = np.minimum(np.abs(phase % 20 - 10), 9.999).astype(np.int32)
    return framed(cells, grid), grid


def test_a_markov_process_passes_the_chapman_kolmogorov_test():
    frames, grid = walk_frames()
    found = chapman_kolmogorov(frames, grid, 0.02, 0.01, [1, 2, 5, 10])
    assert found.times_s == pytest.approx([0.025, 0.05, 0.125, 0.25])
    assert np.abs(found.error[0]).max() < 1e-12  # one lag against one lag
    assert np.abs(found.error).max() < 0.01


def test_a_process_with_memory_fails_it():
    frames, grid = ballistic_frames()
    found = chapman_kolmogorov(frames, grid, 0.05, 0.005, [1, 10, 20])
    assert np.abs(found.error[1:, :2]).max() > 0.2


def test_estimated_curves_are_the_share_that_the_frames_show():
    frames, grid = walk_frames(500)
    found = chapman_kolmogorov(frames, grid, 0.02, 0.01, [1])
    left = np.isin(frames.cells % 4, (0, 1))
    share = (left[:-1] & left[1:]).sum() / left[:-1].sum()
    assert found.estimated[0, 0] == pytest.approx(share, abs=1e-12)


def test_block_errors_tell_chance_from_memory():
    for (frames, grid), markov in ((walk_frames(200, 400), True), (ballistic_frames(), False)):
        samples = block_chains(
            lambda weights, f=frames, g=grid: chapman_kolmogorov(
                f, g, 0.02, 0.005, [5], step_weights=weights
            ),
            lambda found: found.error[0, :2],
            len(frames.times_s) - 1,
            12,
            60,
            np.random.default_rng(4),
        )
        in_errors = np.abs(samples.mean(axis=0)) / samples.std(axis=0)
        assert (in_errors < 4).all() if markov else (in_errors > 20).all()


def test_timescales_are_level_for_a_markov_process_only():
    frames, grid = walk_frames()
    level = timescales_over_lags(frames, grid, [1, 2, 4], n=1)[:, 0]
    assert level == pytest.approx(np.full(3, level[0]), rel=0.1)
    table = timescales_over_lags(*ballistic_frames(), lags=[1, 2], n=12)
    assert table.shape == (2, 12) and np.isnan(table[:, 9:]).all()
    assert abs(table[1, 1] / table[0, 1] - 1) > 0.2


def test_dispersion_of_a_known_walk_by_height():
    rng = np.random.default_rng(3)
    z = np.tile(np.repeat([0.5, 1.5, 9.0], 4000), (50, 1))
    x = np.cumsum(rng.normal(0.01, 0.02, z.shape) * np.where(z < 1, 1.0, 3.0), axis=0)
    found = dispersion_by_height(x, z, np.array([0.0, 1.0, 2.0, 3.0]), 5, 0.5)
    assert found.height_m.tolist() == [0.5, 1.5, 2.5]
    assert found.displacements.tolist() == [45 * 4000, 45 * 4000, 0]
    # Five steps in 0.5 s: variance 5 * 0.02^2 over 2 * 0.5 s, and nine times that.
    assert found.dispersion_m2_s[:2, 0] == pytest.approx([0.002, 0.018], rel=0.05)
    assert found.drift_m_s[:2, 0] == pytest.approx([0.1, 0.3], rel=0.02)
    assert found.dispersion_m2_s[:2, 1].tolist() == [0, 0] and np.isnan(found.drift_m_s[2]).all()
    with pytest.raises(DataError, match="no displacement over 50 frames"):
        dispersion_by_height(x, z, np.array([0.0, 1.0]), 50, 0.5)
