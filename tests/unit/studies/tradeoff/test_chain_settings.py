# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of the trade-off study's chains."""

from bedchain.studies.tradeoff.chain_settings import FACTORIAL, ORDER, chain_settings
from made.realisations import own


def test_every_cell_size_meets_every_lag_and_nothing_comes_twice():
    found = chain_settings(own())
    assert len({one.key.removeprefix(one.axis) for one in found}) == len(found)
    factorial = {(one.columns, one.rows, one.lag) for one in found if one.axis == FACTORIAL}
    grids, lags = ({key[:2] for key in factorial}, {key[2] for key in factorial})
    assert lags == {1, 2, 4, 10, 20, 40, 80}
    assert {(40, 160), (20, 80), (10, 40), (2, 10)} <= grids
    assert len(factorial) == len(grids) * len(lags)
    assert {one.tracers for one in found if one.axis == "tracers"} == {10**n for n in range(2, 7)}
    assert {one.model for one in found if one.axis == ORDER} == {"dynamic"}


def test_settings_that_do_not_fit_are_left_out():
    small = chain_settings(own(2, 6, 0.02, 0.06, frames=5, diameter_m=4e-3))
    assert small and max(one.lag for one in small) <= 5
    assert all(0.02 / one.columns >= 4e-3 and 0.06 / one.rows >= 4e-3 for one in small)
    # the second order needs two steps
    assert all(2 * one.lag <= 5 for one in small if one.model == "dynamic")
    assert not [one for one in chain_settings(own(models=("static",))) if one.axis == ORDER]
