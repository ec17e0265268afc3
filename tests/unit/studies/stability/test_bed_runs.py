# SPDX-License-Identifier: GPL-3.0-or-later
"""What is measured of a bed, and every fault in it seen."""

import math

import numpy as np
import pandas as pd
import pytest

from bedchain.studies.stability.bed_runs import Expected, checks, momentum, observe
from bedchain.studies.stability.beds import StabilityBed, case_of
from bedchain.studies.stability.verdict import (
    INACCURATE,
    STABLE,
    judge,
)


def test_what_must_be_carried_follows_from_the_motion():
    times_s = np.linspace(0, 0.1, 21)
    for carried in (0.0, 1.0, 2.5):
        heights = 0.01 + 0.3 * times_s + (carried - 1) * 9.81 / 2 * times_s**2
        series = pd.DataFrame({"time_s": times_s, "mean_height_m": heights})
        assert momentum(series) == pytest.approx(carried)


def made_series(**columns):
    """bed_series.csv of a bed at rest, with some columns changed."""
    n = 10
    table = {
        "time_s": np.linspace(0.006, 0.06, n), "pressure_drop_Pa": 0.0, "weight_on_gas_1": 0.25,
        "weight_on_floor_1": 0.7, "weight_on_sides_1": 0.05, "mean_height_m": 0.007, "kinetic_energy_J": 0.0,
        "particles_1": 300, "voidage_clips_1": 0, "volume_balance_1": 1e-9, "exchange_error_1": 1e-16,
        "largest_overlap_1": 0.01,
    }  # fmt: skip
    return pd.DataFrame(table | columns)


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        ({"particles_1": [300] * 9 + [299]}, "lost particles"),
        ({"voidage_clips_1": 1}, "raised voidage"),
        ({"kinetic_energy_J": 1e-6}, "kinetic energy"),
        ({"weight_on_floor_1": 0.5}, "weight carried"),
        ({"largest_overlap_1": 0.2}, "deepest overlap"),
        ({"mean_height_m": 0.005}, "mean height"),
        ({"weight_on_gas_1": 0.35, "weight_on_floor_1": 0.6}, "weight on the gas"),
        ({"volume_balance_1": 1e-3}, "gas balance"),
        ({"exchange_error_1": 1e-6}, "exchange"),
        ({"pressure_drop_Pa": math.nan, "mean_height_m": math.nan}, "weight carried"),
    ],
)
def test_whatever_is_wrong_with_a_bed_is_seen(columns, said):
    case = case_of(StabilityBed())
    good = observe(case, made_series())
    expected = Expected(overlap=0.01, reference="x")
    assert judge(checks(good, expected, good)).outcome == STABLE
    found = judge(checks(observe(case, made_series(**columns)), expected, good))
    assert found.outcome == INACCURATE and said in found.quantity
