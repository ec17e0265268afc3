# SPDX-License-Identifier: GPL-3.0-or-later
"""Riser: contents by sections are the hold-up, and the continuous limit."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bedchain.chains.networks.riser import Exchange, mean_residence_s, riser, riser_steps
from bedchain.errors import DataError

SHARE = st.floats(0.01, 0.9)


@given(SHARE, SHARE, st.floats(0, 0.8), st.one_of(st.none(), SHARE), st.integers(1, 12))
def test_contents_by_sections_are_the_hold_up(out, back, refluxed, dense, cells):
    for chain in (
        riser_steps(cells, Exchange(0, 0, out, back, refluxed, dense)),
        riser(cells, 10.0, 5.0, 1.0, Exchange(0, 0, out, back, refluxed, dense, 2.0)),
    ):
        np.testing.assert_allclose(chain.open_chain.hold_up(), chain.contents, rtol=1e-9)


@pytest.mark.parametrize("refluxed", [0.0, 0.3])
def test_mean_tends_to_the_continuous_one_with_the_first_power_of_the_cells(refluxed):
    exact = mean_residence_s(10, 5, 1, 0.2, 0.4, refluxed)
    errors = [
        riser(cells, 10, 5, 1, Exchange(0, 0, 0.2, 0.4, refluxed)).open_chain.residence()[0] - exact
        for cells in (100, 200)
    ]
    assert errors[0] / errors[1] == pytest.approx(2, rel=0.02) and abs(errors[1]) < 0.005


def test_continuous_mean_is_smooth_where_both_exchanges_balance():
    at = [mean_residence_s(10, 5, 1, 0.2, 0.04 + shift, 0.3) for shift in (-1e-4, 0.0, 1e-4)]
    assert at[1] == pytest.approx((at[0] + at[2]) / 2, rel=1e-6)


def test_plug_flow_without_exchange():
    mean, variance = riser_steps(7, Exchange(0, 0, 0, 0.5, 0)).open_chain.residence()
    assert mean == 7 and math.isclose(variance, 0, abs_tol=1e-9)


def test_probabilities_above_1_are_refused():
    with pytest.raises(DataError, match="to_core is 1.2"):
        riser_steps(3, Exchange(0, 0, 0.1, 1.2, 0))
