# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from bedchain.chains import registry
from bedchain.chains.counting import count_moves
from bedchain.chains.estimators import transition_matrix
from bedchain.errors import DataError
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid
from bedchain.uncertainty import bands
from bedchain.uncertainty.bands import memory


def correlated_series(n: int, rho: float, rng: np.random.Generator) -> np.ndarray:
    noise = rng.normal(0, np.sqrt(1 - rho**2), n)
    series = np.empty(n)
    series[0] = rng.normal()
    for step in range(1, n):
        series[step] = rho * series[step - 1] + noise[step]
    return series


def test_weights_are_whole_blocks_that_fill_the_window():
    rng = np.random.default_rng(1)
    for block in (1, 7, 20, 50):
        weights = bands.block_weights(50, block, rng)
        assert weights.sum() == 50 and weights.min() >= 0 and weights.dtype == np.int64
    assert bands.block_weights(50, 50, rng).tolist() == [1] * 50
    drawn = bands.block_weights(40, 20, rng)
    assert (np.abs(np.diff(drawn)) > 0).sum() <= 4
    for block in (0, 51):
        with pytest.raises(DataError, match="do not fit a window of 50 steps"):
            bands.block_weights(50, block, rng)


def test_blocks_see_the_error_that_single_steps_miss():
    rng = np.random.default_rng(2)
    n, rho = 4000, 0.9
    series = correlated_series(n, rho, rng)
    true_error = np.sqrt((1 + rho) / (1 - rho) / n)
    by_block = bands.block_means(series, 150, 400, rng).std()
    by_step = bands.block_means(series, 1, 400, rng).std()
    assert by_block == pytest.approx(true_error, rel=0.3)
    assert by_step < true_error / 3


def test_the_band_covers_the_truth_nineteen_times_of_twenty():
    rng = np.random.default_rng(3)
    covered = 0
    for _ in range(200):
        low, high = bands.band(bands.block_means(correlated_series(600, 0.6, rng), 25, 150, rng))
        covered += bool(low <= 0 <= high)
    assert 0.85 <= covered / 200 <= 0.99


def test_means_keep_the_shape_of_what_is_averaged():
    series = np.random.default_rng(4).random((30, 2, 3))
    means = bands.block_means(series, 30, 4, np.random.default_rng(5))
    assert means.shape == (4, 2, 3) and np.allclose(means, series.mean(axis=0))
    low, high = bands.band(means)
    assert low.shape == (2, 3) and (low <= high + 1e-15).all()


def test_correlation_time_of_a_known_series():
    rng = np.random.default_rng(6)
    assert bands.correlation_steps(correlated_series(200_000, 0.8, rng)) == pytest.approx(9.0, rel=0.15)
    assert bands.correlation_steps(rng.normal(size=50_000)) < 1.3
    # the mean of 0.05 is off by round-off, which is no memory
    assert bands.correlation_steps(np.ones(10)) == bands.correlation_steps(np.full(12_000, 0.05)) == 1.0


def gusts(rng: np.random.Generator, n_frames: int, n_particles: int) -> np.ndarray:
    """Particles in two cells that all change more readily while a gust lasts, as those of one bubble do."""
    gust = correlated_series(n_frames, 0.95, rng) > 0.5
    cells = np.empty((n_frames, n_particles), np.int32)
    cells[0] = rng.integers(0, 2, n_particles)
    for frame in range(1, n_frames):
        change = rng.random(n_particles) < (0.3 if gust[frame] else 0.02)
        cells[frame] = np.where(change, 1 - cells[frame - 1], cells[frame - 1])
    return cells


def test_block_error_of_a_chain_agrees_with_repeats_and_the_binomial_one_does_not():
    rng = np.random.default_rng(7)
    grid = Grid(2.0, 1.0, 2, 1)

    def leaving(cells: np.ndarray, weights: np.ndarray | None = None) -> float:
        return float(transition_matrix(count_moves(cells, grid.n_cells, step_weights=weights))[0, 1])

    repeats = [leaving(gusts(rng, 1500, 40)) for _ in range(40)]
    errors = []
    for _ in range(8):
        cells = gusts(rng, 1500, 40)
        samples = bands.block_chains(lambda w, c=cells: leaving(c, w), np.array, 1499, 150, 60, rng)
        errors.append(samples.std())
    p = float(np.mean(repeats))
    binomial = np.sqrt(p * (1 - p) / (1499 * 20))
    # Forty repeats know their spread to 11 %, and ten blocks a window come out 10 to 20 % low.
    assert np.mean(errors) == pytest.approx(np.std(repeats), rel=0.4)
    assert binomial < np.std(repeats) / 4


@pytest.mark.parametrize("name", list(registry.LEARNERS))
def test_bands_on_the_curves_of_every_model(name):
    rng = np.random.default_rng(8)
    grid = Grid(2.0, 1.0, 2, 1)
    cells = gusts(rng, 200, 100)
    frames = Frames(np.arange(200) * 0.1, cells + 0.5, np.full(cells.shape, 0.5), cells)
    # frames are compared in cells of 2 cm unless told otherwise: far too many for a bed of 2 m
    options = {"coarse_m": 0.5} if name == "recurrence" else {}
    samples = bands.block_chains(
        lambda weights: registry.learn(name, frames, grid, step_weights=weights, **options),
        lambda chain: chain.mixing(frames.part(slice(0, 2)), 1.0, 0.4, 10)[:, :2],
        199,
        20,
        30,
        rng,
    )
    low, high = bands.band(samples)
    middle = registry.learn(name, frames, grid, **options).mixing(frames.part(slice(0, 2)), 1.0, 0.4, 10)[
        :, :2
    ]
    assert samples.shape == (30, 11, 2) and (low[0] == high[0]).all()
    assert ((low <= middle) & (middle <= high))[1:].mean() > 0.8 and (high - low)[1:].min() > 0


def test_memory_is_that_of_a_sloshing_bed():
    rng = np.random.default_rng(2)
    phase = np.cumsum(rng.normal(0, 0.3, 12_000))
    x = 0.05 + 0.02 * np.cos(phase)[:, None] + rng.normal(0, 0.005, (12_000, 40))
    z = np.full(x.shape, 0.05)
    frames = Frames(np.arange(len(x)) * 0.025, x, z, np.zeros(x.shape, np.int32))
    # a cosine of a random walk forgets with exp(-0.3^2 n / 2): integrated, 2 / 0.045 = 44 frames
    assert memory(frames, 0.05) == pytest.approx(44, rel=0.25)
