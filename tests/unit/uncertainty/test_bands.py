# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from bedchain.trajectory.frames import Frames
from bedchain.uncertainty import bands
from bedchain.uncertainty.bands import BLOCKS, STUDENT, block_band, memory
from made.series import correlated_series


def test_blocks_fill_the_window_and_each_is_left_out_once():
    for n_steps in (5, 23, 200):
        weights = np.array([bands.kept_steps(kept, n_steps) for kept in bands.kept_blocks()])
        assert (weights.sum(axis=0) == BLOCKS - 1).all()
        sizes = n_steps - weights.sum(axis=1)
        assert sizes.max() - sizes.min() <= 1 and (np.diff(weights, axis=1) != 0).sum() == 2 * BLOCKS - 2


def test_the_band_of_a_mean_is_students():
    series = np.random.default_rng(1).normal(3, 1, 50)
    low, high = block_band(series.mean(), bands.means_left_out(series))
    means = series.reshape(BLOCKS, -1).mean(axis=1)
    half = STUDENT * means.std(ddof=1) / np.sqrt(BLOCKS)
    assert [low, high] == pytest.approx([series.mean() - half, series.mean() + half])
    assert pytest.approx(2.776445) == STUDENT


def test_the_error_of_a_mean_is_that_of_its_blocks():
    series = np.random.default_rng(1).normal(3, [1, 4], (50, 2))
    means = series.reshape(BLOCKS, -1, 2).mean(axis=1)
    assert bands.mean_error(series) == pytest.approx(means.std(axis=0, ddof=1) / np.sqrt(BLOCKS))


def test_bands_stay_on_their_scale():
    left_out = np.linspace(0.1, 3, BLOCKS)[:, None] * np.array([1.0, 2.0])
    low, high = block_band(np.array([1.0, 2.0]), left_out, "positive")
    assert (low > 0).all() and low[1] / low[0] == pytest.approx(2) and high[1] / high[0] == pytest.approx(2)
    shares = np.linspace(0.4, 0.99, BLOCKS)
    low, high = block_band(0.9, shares, "share")
    other_low, other_high = block_band(0.1, 1 - shares, "share")
    assert 0 < low < 0.9 < high < 1 and [other_low, other_high] == pytest.approx([1 - high, 1 - low])


def test_at_the_end_of_a_scale_the_band_is_cut():
    low, high = block_band(
        np.array([1.0, 0.01, 0.0]), np.array([[1, 0.0, 0]] * 2 + [[1, 0.02, 0]] * 3), "share"
    )
    assert low.tolist() == [1, 0, 0] and high[[0, 2]].tolist() == [1, 0] and 0.01 < high[1] < 0.1


def test_a_window_too_short_and_a_missing_number_have_no_band():
    left_out = np.linspace(1, 2, BLOCKS)[:, None] * np.ones(2)
    assert np.isnan(block_band(np.ones(2), left_out, correlation_times=4.9)).all()
    assert np.isnan(block_band(np.ones(2), left_out[:0])).all()
    left_out[0, 1] = np.nan
    low, _ = block_band(np.ones(2), left_out, correlation_times=5)
    assert np.isfinite(low[0]) and np.isnan(low[1])
    assert "4.9 correlation times are too short" in bands.shortness(4.9) and not bands.shortness(5.0)


def test_means_keep_the_shape_of_the_series():
    series = np.random.default_rng(4).random((30, 2, 3))
    means = bands.means_left_out(series)
    assert means.shape == (BLOCKS, 2, 3) and np.allclose(means[0], series[6:].mean(axis=0))


def test_correlation_time_of_a_known_series():
    rng = np.random.default_rng(6)
    assert bands.correlation_steps(correlated_series(200_000, 0.8, rng)) == pytest.approx(9.0, rel=0.15)
    assert bands.correlation_steps(rng.normal(size=50_000)) < 1.3
    # the mean of 0.05 is off by round-off, which is no memory
    assert bands.correlation_steps(np.ones(10)) == bands.correlation_steps(np.full(12_000, 0.05)) == 1.0


def test_memory_is_that_of_a_sloshing_bed():
    rng = np.random.default_rng(2)
    phase = np.cumsum(rng.normal(0, 0.3, 12_000))
    x = 0.05 + 0.02 * np.cos(phase)[:, None] + rng.normal(0, 0.005, (12_000, 40))
    z = np.full(x.shape, 0.05)
    frames = Frames(np.arange(len(x)) * 0.025, x, z, np.zeros(x.shape, np.int32))
    # a cosine of a random walk forgets with exp(-0.3^2 n / 2): integrated, 2 / 0.045 = 44 frames
    assert memory(frames, 0.05) == pytest.approx(44, rel=0.25)
    assert bands.correlation_times(frames, 0.05, 400) == pytest.approx(11_600 / 400)
