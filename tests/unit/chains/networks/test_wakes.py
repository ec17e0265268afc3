# SPDX-License-Identifier: GPL-3.0-or-later
"""Axial chain with wakes: uniform contents whatever the wakes do, and its limits."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bedchain.chains.networks.wakes import axial_wakes
from bedchain.errors import DataError


@given(
    st.lists(st.floats(0, 0.02), min_size=2, max_size=8), st.floats(0, 0.1), st.sampled_from([None, 0.3, 1.0])
)
def test_contents_are_the_declared_ones_whatever_the_wakes_do(caught, up, wake):
    chain = axial_wakes(caught, up, 0.05, wake)
    np.testing.assert_allclose(chain.open_chain.hold_up(), chain.contents, rtol=1e-9)
    mean = chain.open_chain.residence()[0]
    assert mean == pytest.approx(chain.contents.sum() / 0.05)


def test_without_wakes_and_dispersion_it_is_plug_flow_of_tanks():
    mean, variance = axial_wakes([0] * 5, 0.0, 0.05).open_chain.residence()
    assert (mean, variance) == pytest.approx((5 / 0.05, 5 * 0.95 / 0.05**2))


def test_many_cells_without_dispersion_tend_to_the_continuum():
    # mass left of a pulse put in at the top is exp(-lambda t) at x = 1 - exp(-lambda t), density 1 behind it
    cells, lag = 400, 5e-4
    chain = axial_wakes([lag] * cells, 0.0)
    after = chain.expected(np.eye(cells)[0], round(1 / lag))[-1]
    front = 1 - np.exp(-1)
    behind = after[: int(0.85 * front * cells)] * cells
    np.testing.assert_allclose(behind, 1, rtol=0.02)
    assert after[int(1.1 * front * cells) :].sum() < 1e-3


def test_too_fast_moves_are_refused():
    with pytest.raises(DataError, match=r"out of cell 2 sum to 1.4, more than 1"):
        axial_wakes([0.3, 0.3, 0.3], 0.4)
