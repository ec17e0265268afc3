# SPDX-License-Identifier: GPL-3.0-or-later
"""What carries the weight of made-up two-fluid beds."""

import numpy as np
import pandas as pd
import pytest

from bedchain.case.load import load_case
from bedchain.dem.two_fluid_balance import COLUMNS, balance, balance_table, carried
from bedchain.physics.granular import Granular
from made import ROOT

GRANULAR = Granular(2600.0, 0.9, 0.605)


@pytest.fixture
def case():
    return load_case(ROOT / "cases" / "short" / "case.yaml")


def column(rows=4000):
    """Solids that thin out upwards in fine cells, (rows, 1)."""
    height = (np.arange(rows) + 0.5)[:, None] / rows
    return 0.45 * (1 - height), height


def test_a_push_at_one_temperature_is_the_pressure_on_the_floor(case):
    solids, _ = column()
    theta = np.full_like(solids, 0.004)
    terms = balance(solids, theta, np.full_like(solids, 1e5), np.zeros_like(solids), case, GRANULAR)
    assert terms.solids_pressure == pytest.approx(terms.floor_pressure, rel=1e-3)


def test_a_push_at_a_temperature_that_rises_upwards_is_more_than_the_pressure_on_the_floor(case):
    solids, height = column()
    terms = balance(solids, 0.004 * height, np.full_like(solids, 1e5), np.zeros_like(solids), case, GRANULAR)
    assert terms.solids_pressure > 100 * abs(terms.floor_pressure)


def test_gas_pressure_is_that_of_the_floor_and_weight_and_momentum_are_sums(case):
    cell_m = case["gas"]["cell_size_m"]
    solids = np.array([[0.5, 0.5], [0.3, 0.1]])
    pressure = 1e5 + np.array([[30.0, 30.0], [10.0, 10.0]])
    upwards = np.array([[1.0, 1.0], [-1.0, 0.0]])
    terms = balance(solids, np.zeros((2, 2)), pressure, upwards, case, GRANULAR)
    assert terms.gas_pressure == pytest.approx(40.0)
    assert terms.weight == pytest.approx((0.7 * 2600 + 1.3 * 1.2) * 9.81 * cell_m)
    assert terms.momentum == pytest.approx((0.5 - 0.15) * 2600 * cell_m)
    assert terms.solids_pressure == terms.floor_pressure == 0


def test_shares_of_what_carries_the_weight_sum_to_one():
    table = pd.DataFrame(
        [(1.0, 100.0, 80.0, 15.0, 2.0, 0.0), (3.0, 100.0, 90.0, 5.0, 4.0, 6.0)], columns=COLUMNS
    )
    shares = carried(table)
    assert shares["gas_pressure"] == pytest.approx(0.85) and shares["floor_pressure"] == pytest.approx(0.03)
    # what speeds up has to be carried as well
    assert shares["momentum"] == pytest.approx(-0.03)
    assert shares["rest"] == pytest.approx(1 - 0.85 - 0.10 + 0.03)
    assert list(balance_table([], [])) == COLUMNS
