# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed forms of conversion: their limits, and the balances that they solve."""

import numpy as np
import pytest
from scipy.integrate import solve_bvp

from bedchain.physics import reactors


def test_many_tanks_are_plug_flow_and_one_is_mixed():
    assert reactors.tanks(2.0, 10**7) == pytest.approx(reactors.plug_flow(2.0), rel=1e-6)
    assert reactors.tanks(2.0, 1) == pytest.approx(2 / 3)


def test_dispersion_solves_its_equation_with_closed_ends():
    number, peclet = 2.0, 5.0

    def slopes(x, y):
        return np.vstack((y[1], peclet * (y[1] + number * y[0])))

    def ends(left, right):
        return np.array([left[0] - left[1] / peclet - 1, right[1]])

    grid = np.linspace(0, 1, 50)
    solution = solve_bvp(slopes, ends, grid, np.ones((2, 50)), tol=1e-8)
    assert reactors.dispersed(number, peclet) == pytest.approx(1 - solution.y[0, -1], abs=1e-6)


def test_dispersion_has_plug_flow_and_a_mixed_tank_at_its_ends():
    assert reactors.dispersed(2.0, 1e5) == pytest.approx(reactors.plug_flow(2.0), rel=1e-4)
    assert reactors.dispersed(2.0, 1e-5) == pytest.approx(2 / 3, rel=1e-4)
    assert reactors.dispersed_variance(20) == pytest.approx(0.095, abs=1e-6)
    assert reactors.dispersed_variance(1e-3) == pytest.approx(1, abs=1e-3)


def test_mixed_emulsion_is_its_two_balances():
    share, crossflow, number = 0.8, 2.0, 1.0
    emulsion = np.linspace(0, 1, 200_001)
    bubble = emulsion + (1 - emulsion) * np.exp(-crossflow)
    balance = (1 - share) * (1 - emulsion) + share * (1 - bubble) - number * emulsion
    at = np.argmin(np.abs(balance))
    expected = 1 - share * bubble[at] - (1 - share) * emulsion[at]
    assert reactors.mixed_emulsion(share, crossflow, number) == pytest.approx(expected, abs=1e-5)
    assert 1 - reactors.mixed_emulsion(share, crossflow, number) == pytest.approx(0.528616, abs=1e-6)


def test_two_phases_without_exchange_react_in_the_emulsion_alone():
    alone = reactors.two_phases(2.0, (0.08, 0.02), 1e-12, 0.03)
    assert alone == pytest.approx(0.2 * reactors.plug_flow(0.03 * 2 / 0.02))
    joined = reactors.two_phases(2.0, (0.08, 0.02), 1e4, 0.03)
    assert joined == pytest.approx(reactors.plug_flow(0.03 * 2 / 0.1), rel=1e-3)


def test_three_phases_are_resistances_in_series():
    assert reactors.three_phase_rate((0.0, 0.0, 1e9), 2.0, 2.0) == pytest.approx(1.0)
    assert reactors.three_phase_rate((0.5, 1e9, 1.0), 2.0, 2.0) == pytest.approx(2.5)
