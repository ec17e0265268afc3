# SPDX-License-Identifier: GPL-3.0-or-later
"""Drifts: exact without noise, seldom in steady series that swing, and detected where there is a drift."""

import numpy as np
import pytest
from scipy.signal import lfilter

from bedchain.uncertainty.stationarity import drift, drift_table

# a share of 150 series that is truly 5 % is below this with a probability of 99.9 %
SERIES, MOST_ALARMS = 150, 0.11
MEMORY, LENGTH = 10.0, 400


def swinging(n, length, memory, seed):
    """Series (n, length) of variance 1 whose correlation falls as exp(-t / memory)."""
    keep = np.exp(-1 / memory)
    noise = np.random.default_rng(seed).normal(size=(n, length + 20 * int(memory)))
    return lfilter([np.sqrt(1 - keep**2)], [1, -keep], noise)[:, -length:]


def test_a_straight_line_is_found_exactly():
    line = drift(3.0 + np.linspace(0, 0.5, 50))
    assert line.mean == pytest.approx(3.25)
    assert line.change == pytest.approx(0.5)
    assert line.low == pytest.approx(0.5) and line.high == pytest.approx(0.5)
    assert not line.stationary


def test_a_constant_is_steady():
    assert drift(np.full(40, 0.7)).stationary


@pytest.mark.parametrize("memory", [0.5, 3.0, MEMORY])
def test_steady_series_raise_few_alarms(memory):
    alarms = [not drift(series).stationary for series in swinging(SERIES, LENGTH, memory, 1)]
    assert np.mean(alarms) < MOST_ALARMS


def test_errors_of_independent_times_would_raise_many():
    """The test above can fail: least squares' own error takes a swing for a drift."""
    line = np.linspace(-0.5, 0.5, LENGTH)
    series = swinging(SERIES, LENGTH, MEMORY, 1)
    change = series @ line / (line @ line)
    error = 1 / np.sqrt(line @ line)
    assert np.mean(np.abs(change) > 2 * error) > 0.4


def test_a_drift_of_some_swings_is_found():
    drifting = swinging(SERIES, LENGTH, MEMORY, 2) + np.linspace(0, 3.5, LENGTH)
    drifts = [drift(series) for series in drifting]
    assert np.mean([not line.stationary and line.low > 0 for line in drifts]) > 0.9
    assert np.mean([line.change for line in drifts]) == pytest.approx(3.5, abs=0.3)


def test_table_has_every_series_and_every_row_that_holds_particles():
    rng = np.random.default_rng(3)
    steady = rng.normal(10, 1, 200)
    profile = np.column_stack([rng.normal(0.6, 0.01, 200), 0.7 + 0.1 * np.linspace(0, 1, 200), np.ones(200)])
    table = drift_table({"pressure_drop": ("Pa", 5e-3, steady)}, profile, np.array([0.1, 0.2, 0.3]), 0.025)
    assert table["quantity"].tolist() == ["pressure_drop", "voidage", "voidage"]
    assert table["stationary_1"].tolist() == [1, 1, 0]
    assert table["drift"].iloc[2] == pytest.approx(0.1)
    assert table["block_s"].iloc[0] == pytest.approx(3 * 5e-3, rel=0.5)


def test_many_steady_rows_together_raise_few_alarms():
    alarms = 0
    for seed in range(20):
        profile = 0.6 + 0.01 * swinging(30, LENGTH, 3.0, 100 + seed).T
        alarms += (drift_table({}, profile, np.arange(30.0), 0.025)["stationary_1"] == 0).any()
    # with 5 % for the whole profile: 6 of 20 or more have a probability of 0.03 %
    assert alarms < 6
