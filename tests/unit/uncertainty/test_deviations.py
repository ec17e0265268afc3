# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors over starts and runs, their noise floor and intervals, against naive loops and known answers."""

import numpy as np
import pytest

from bedchain.uncertainty.deviations import (
    deviations,
    distances,
    fluctuation,
    interval,
    mean_of_others,
    mean_size,
    resampled,
    rms,
    signed,
    stacked,
)

ROUND_OFF = 1e-12
# standard errors of a mean of some hundred draws
SIGMAS = 4.0


def ragged(seed=0, lengths=(5, 3, 4), columns=2):
    """Curves of unequal length."""
    rng = np.random.default_rng(seed)
    return [rng.normal(0.1, 0.3, (length, columns)) for length in lengths]


def test_sums_over_curves_of_unequal_length_are_those_of_a_loop():
    curves = ragged()
    values = [value for curve in curves for row in curve for value in row]
    error = stacked(curves)
    assert error.shape == (3, 5, 2)
    assert signed(error) == pytest.approx(sum(values) / len(values), abs=ROUND_OFF)
    assert rms(error) == pytest.approx((sum(v**2 for v in values) / len(values)) ** 0.5, abs=ROUND_OFF)
    means = [curve.mean() for curve in curves]
    assert mean_size(error) == pytest.approx(np.sqrt(np.mean(np.square(means))), abs=ROUND_OFF)


def test_weights_count_curves_as_often_as_they_say():
    curves = ragged(1)
    twice = stacked([curves[0], curves[2], curves[2]])
    weights = np.array([[1.0, 0.0, 2.0], [1.0, 1.0, 1.0]])
    for summary in (signed, rms, mean_size):
        values = summary(stacked(curves), weights)
        assert values[0] == pytest.approx(float(summary(twice)), abs=ROUND_OFF)
        assert values[1] == pytest.approx(float(summary(stacked(curves))), abs=ROUND_OFF)


def test_runs_are_drawn_whole_and_their_curves_inside_them():
    run = np.array([0, 0, 0, 1, 1, 1])
    weights = resampled(run, 400, np.random.default_rng(1))
    assert (weights.sum(axis=1) == 6).all()
    of_first = weights[:, :3].sum(axis=1)
    assert set(of_first) == {0, 3, 6}
    assert (of_first == 3).mean() == pytest.approx(0.5, abs=SIGMAS * 0.5 / 20)
    alone = resampled(np.zeros(4, int), 100, np.random.default_rng(2))
    assert (alone.sum(axis=1) == 4).all() and alone.std() > 0


def test_interval_of_a_mean_is_that_of_theory():
    error = np.random.default_rng(3).normal(0.2, 1.0, (200, 1, 1))
    weights = resampled(np.zeros(200, int), 1000, np.random.default_rng(4))
    low, high = interval(signed, error, weights)
    assert low < 0.2 < high
    assert high - low == pytest.approx(2 * 1.96 / np.sqrt(200), rel=0.15)


def test_a_single_curve_has_no_interval():
    error = stacked([np.ones((3, 1)), np.full((3, 1), np.nan)])
    weights = resampled(np.array([0, 1]), 10, np.random.default_rng(5))
    assert np.isnan(interval(rms, error, weights)).all()


def test_identical_repeats_have_no_noise_floor():
    curve = np.random.default_rng(6).random((7, 4))
    scaled = deviations(np.stack([curve, curve, curve]), np.zeros(3, int))
    assert np.abs(scaled).max() < ROUND_OFF
    shares = np.abs(np.random.default_rng(7).random((1, 3, 5)))
    same = np.repeat(shares, 3, axis=0)
    assert np.abs(distances(same, mean_of_others(same, np.zeros(3, int)))).max() < ROUND_OFF


def test_noise_floor_is_the_standard_deviation_of_one_run():
    rng = np.random.default_rng(8)
    number = np.tile(np.arange(100), 3)
    curves = rng.normal(0, 0.05, (300, 4, 1)) + number[:, None, None]
    error = float(rms(deviations(curves, number)))
    assert error == pytest.approx(0.05, rel=SIGMAS / np.sqrt(2 * 200 * 4))


def test_noise_floor_of_unequal_lengths_counts_what_is_left():
    curves = stacked([np.array([[1.0], [2.0]]), np.array([[3.0]])])
    scaled = deviations(curves, np.zeros(2, int))
    # two numbers that differ by 2 have the standard deviation sqrt(2), and one alone has none
    assert scaled[:, 0, 0] == pytest.approx([-(2**0.5), 2**0.5])
    assert np.isnan(scaled[:, 1]).all()


def test_groups_are_compared_among_themselves_only():
    curves = np.array([0.0, 0.0, 5.0, 5.0]).reshape(4, 1, 1)
    assert rms(deviations(curves, np.array([0, 0, 1, 1]))) == 0
    assert rms(deviations(curves, np.zeros(4, int))) == pytest.approx(np.std([0, 0, 5, 5], ddof=1))


def test_total_variation_of_batches_is_that_of_a_loop():
    rng = np.random.default_rng(9)
    first, second = rng.dirichlet(np.ones(6), (2, 3)), rng.dirichlet(np.ones(6), (2, 3))
    first[1, 2] = np.nan
    distance = distances(first, second)
    for curve, moment in np.ndindex(2, 3):
        wanted = 0.5 * sum(
            abs(a - b) for a, b in zip(first[curve, moment], second[curve, moment], strict=True)
        )
        assert distance[curve, moment, 0] == pytest.approx(wanted, nan_ok=True)
    assert np.isnan(distance[1, 2, 0])


def test_mean_of_others_leaves_oneself_out():
    densities = np.array([[[1.0, 0.0]], [[0.0, 1.0]], [[0.5, 0.5]]])
    means = mean_of_others(densities, np.zeros(3, int))
    assert means[0, 0] == pytest.approx([0.25, 0.75])
    assert np.isnan(mean_of_others(densities, np.arange(3))).all()


def test_fluctuations_of_a_sine_about_a_line_are_found_and_the_line_is_not():
    times = np.arange(400) * 0.025
    line, sine = 1 - 0.05 * times, 0.04 * np.sin(2 * np.pi * times / 0.1)
    curves = np.stack([line + sine, line])[:, :, None]
    fluctuations = fluctuation(curves, 10)
    assert fluctuations.shape == (2, 380, 1)
    # 21 times hold five periods of four and one time more: what is left of the mean is 1/21 of the sine
    assert rms(fluctuations[:1]) == pytest.approx(0.04 / 2**0.5, rel=2 / 21)
    assert np.abs(fluctuations[1]).max() < ROUND_OFF
    assert fluctuation(curves[:, :20], 10).shape[1] == 0
