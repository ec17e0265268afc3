# SPDX-License-Identifier: GPL-3.0-or-later
"""The noise floor: by hand, against drawn realisations, and what it says of a chain."""

import numpy as np
import pandas as pd
import pytest

from bedchain.comparison.curves import curve_table, curves_of
from bedchain.comparison.metrics import floor_metrics, noise_metrics
from bedchain.dem.repeats import LARGEST_SEED, kick_seed, segment_that_ends
from bedchain.errors import UserError
from bedchain.physics.whole_numbers import is_prime
from bedchain.uncertainty.noise_floor import noise_floor

TIMES = np.array([1.0, 1.5, 2.0])
# 400 beds of four realisations: the share inside a 95 % interval is known to 1.1 %
BEDS, TRIAL_ERROR = 400, 0.035


def of_all_groups(rows):
    """(n_realisations, n_times, 4) of (n_realisations, n_times): the same in each group."""
    return np.repeat(np.array(rows, float)[:, :, None], 4, axis=2)


def values(rows):
    return {row["quantity"]: row["value"] for row in rows}


def test_floor_by_hand():
    curves = of_all_groups([[1, 0.8, 0.6], [1, 0.9, 0.8], [1, 0.7, 0.4]])
    floor, (low, high) = noise_floor(curves[:, 1:])
    np.testing.assert_allclose(floor, ((0.1**2 + 0.2**2) / 2) ** 0.5)
    # tables of chi square: 7.378 and 0.05064 with two degrees of freedom
    np.testing.assert_allclose(low, floor * (2 / 7.378) ** 0.5, rtol=1e-3)
    np.testing.assert_allclose(high, floor * (2 / 0.05064) ** 0.5, rtol=1e-3)
    assert values(floor_metrics(curves))["realisations"] == 3


def test_floor_is_the_difference_of_two_realisations_over_the_root_of_two():
    rng = np.random.default_rng(3)
    curves = rng.normal(size=(5, 40, 4))
    pairs = [((curves[i] - curves[j]) ** 2).mean(axis=0) for i in range(5) for j in range(i)]
    np.testing.assert_allclose(noise_floor(curves)[0], np.sqrt(np.mean(pairs, axis=0) / 2))


def test_interval_covers_the_truth_where_a_curve_moves_as_a_whole():
    rng = np.random.default_rng(4)
    inside = 0
    for _ in range(BEDS):
        curves = of_all_groups(rng.normal(0, 0.05, (4, 1)) * np.ones((4, 20)))
        _, (low, high) = noise_floor(curves)
        inside += low[0] <= 0.05 <= high[0]
    assert inside / BEDS == pytest.approx(0.95, abs=TRIAL_ERROR)


def test_a_chain_that_is_the_mean_has_the_floor_as_its_error():
    rng = np.random.default_rng(5)
    curves = 0.5 + rng.normal(0, 0.05, (400, 30, 4))
    metrics = values(noise_metrics("static", np.full((30, 4), 0.5), curves))
    for group in ("left", "right", "low", "up"):
        assert metrics[f"error_over_noise_{group}"] == pytest.approx(1, abs=0.4)
        assert metrics[f"error_rms_of_mean_{group}"] < 0.01
    off = values(noise_metrics("static", np.full((30, 4), 0.6), curves))
    assert off["error_signed_of_mean_left"] == pytest.approx(0.1, abs=0.005)
    assert off["error_over_noise_left"] > 2


def test_equal_realisations_give_a_floor_of_nothing_and_no_ratio():
    curves = of_all_groups([[1, 0.8, 0.6]] * 3)
    assert values(floor_metrics(curves))["noise_floor_left"] == pytest.approx(0, abs=1e-15)
    assert "error_over_noise_left" not in values(noise_metrics("static", curves[0], curves))


def test_curves_come_back_from_the_table():
    curves = np.arange(12).reshape(3, 4) / 12
    table = pd.concat([curve_table(TIMES, "dem", 0 * curves), curve_table(TIMES, "dem_1", curves)])
    np.testing.assert_array_equal(curves_of(table, "dem_1", 3), curves)
    with pytest.raises(UserError, match="dem_2: 0 times, 3 expected"):
        curves_of(table, "dem_2", 3)


def test_seeds_of_repeats_are_different_primes():
    for seed in (10007, 15485863, 32452843, LARGEST_SEED):
        seeds = [kick_seed(seed, number) for number in range(1, 20)]
        assert len(set(seeds)) == len(seeds)
        assert all(is_prime(seed) and 10000 < seed <= LARGEST_SEED for seed in seeds)


def test_a_repeat_finds_its_segment_or_says_where_it_can_start():
    ends = (0.5, 1.0, 1.5)
    segments = [{"end_s": end, "folder": f"dem/a/segment_{i}"} for i, end in enumerate(ends)]
    manifest = {"dem_step_s": 2e-5, "segments": segments}
    assert segment_that_ends(manifest, 1.0000001).name == "segment_1"
    with pytest.raises(UserError, match=r"ends at 1.2 s.*take 1 s.*time.segment_s that divides 1.2 s"):
        segment_that_ends(manifest, 1.2)
