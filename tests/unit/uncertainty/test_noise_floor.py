# SPDX-License-Identifier: GPL-3.0-or-later
"""The noise floor: by hand, against drawn realisations, and what it says of a chain."""

import numpy as np
import pytest

from bedchain.comparison.metrics import floor_metrics
from bedchain.uncertainty.noise_floor import noise_floor

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
