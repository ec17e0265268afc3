# SPDX-License-Identifier: GPL-3.0-or-later
"""A scalar on a chain: exact decay, balance, and both limits of its rate."""

import numpy as np
import pytest
from scipy import sparse

from bedchain.chains.scalar import (
    effective_rate,
    gained,
    lost_in_a_step,
    scalar_chain,
    scalar_over_time,
)
from bedchain.errors import DataError

MATRIX = sparse.csr_array([[0.7, 0.3, 0.0], [0.1, 0.8, 0.1], [0.0, 0.5, 0.5]])
DENSITY = np.array([5.0, 15.0, 3.0]) / 23
NONE = np.zeros(3)
ROUND_OFF = 1e-12


def test_an_even_loss_decays_exactly_whatever_moves():
    chain = scalar_chain(MATRIX, np.full(3, 2.0), NONE + 1e-300, 0.1)
    amounts = scalar_over_time(chain, np.array([1.0, 0, 2.0]), 20).sum(axis=1)
    np.testing.assert_allclose(amounts, 3 * np.exp(-0.2 * np.arange(21)), rtol=ROUND_OFF)


def test_one_state_alone_gains_and_loses_exactly():
    chain = scalar_chain(sparse.csr_array([[1.0]]), np.array([3.0]), np.array([5.0]), 0.2)
    amounts = scalar_over_time(chain, np.array([0.0]), 10)[:, 0]
    np.testing.assert_allclose(amounts, 5 / 3 * (1 - np.exp(-3 * 0.2 * np.arange(11))), atol=ROUND_OFF)
    assert chain.hold_up()[0] == pytest.approx(5 / 3)


def test_what_is_gained_is_lost_in_the_steady_state():
    loss, gain = np.array([0.0, 1.0, 7.0]), np.array([4.0, 0.5, 0.25])
    steady = scalar_chain(MATRIX, loss, gain, 0.3).hold_up()
    assert lost_in_a_step(loss, gain, steady, 0.3) == pytest.approx(gain.sum() * 0.3, rel=ROUND_OFF)


def test_over_time_a_start_comes_to_the_steady_state():
    loss, gain = np.array([0.0, 0.0, 7.0]), np.array([4.0, 0.0, 0.0])
    chain = scalar_chain(MATRIX, loss, gain, 0.3)
    np.testing.assert_allclose(scalar_over_time(chain, NONE, 4000)[-1], chain.hold_up(), rtol=1e-9)


def test_a_slow_loss_sees_the_mean_and_a_fast_one_what_mixing_brings():
    wall = np.array([0.0, 0.0, 1.0])
    slow = effective_rate(MATRIX, DENSITY, 1e-7 * wall, 0.1)
    assert slow == pytest.approx(1e-7 * DENSITY[2], rel=1e-4)
    fast = [effective_rate(MATRIX, DENSITY, rate * wall, 0.1) for rate in (1e6, 1e9)]
    assert fast[0] == pytest.approx(fast[1], rel=1e-4) and fast[0] < 1 / 0.1


def test_gains_without_loss_add_up():
    np.testing.assert_allclose(gained(np.array([0.0, 1e-30]), np.array([2.0, 2.0]), 0.5), 1.0)


@pytest.mark.parametrize(
    ("loss", "gain", "message"),
    [(NONE - 1, NONE + 1, "negative"), (NONE, NONE + 1, "lost nowhere"), (NONE + 1, NONE, "nothing enters")],
)
def test_what_cannot_be_is_refused(loss, gain, message):
    with pytest.raises(DataError, match=message):
        scalar_chain(MATRIX, loss, gain, 0.1)


def test_what_never_comes_to_a_loss_is_named():
    apart = sparse.csr_array([[1.0, 0.0], [0.0, 1.0]])
    with pytest.raises(DataError, match="no exit can be reached from state 0"):
        scalar_chain(apart, np.array([0.0, 1.0]), np.ones(2), 0.1).hold_up()
