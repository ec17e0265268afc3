# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains from flows: contents carried exactly, groups kept, a steady roll that mixes along itself."""

import numpy as np
import pytest

from bedchain.chains.flow_chain import Fluxes, carried, contents_of, generator, remaining

RNG = np.random.default_rng(5)


def changing(nz=4, nx=3, duration=0.1):
    """Contents that change just by their flows."""
    right, up = RNG.normal(0, 1, (nz, nx - 1)), RNG.normal(0, 1, (nz - 1, nx))
    gain = np.zeros((nz, nx))
    gain[:, :-1] -= right
    gain[:, 1:] += right
    gain[:-1] -= up
    gain[1:] += up
    before = RNG.uniform(1, 2, (nz, nx))
    return Fluxes(before, before + gain * duration, right, up), duration


def test_what_fills_every_cell_goes_on_filling_it():
    fluxes, duration = changing()
    marked = carried(fluxes.before.reshape(1, -1), fluxes, duration)
    np.testing.assert_allclose(marked[0], fluxes.after.ravel(), rtol=1e-12)


def test_groups_are_kept_and_stay_positive():
    fluxes, duration = changing()
    share = RNG.uniform(0, 1, (2, 12))
    marked = share * fluxes.before.ravel()
    after = carried(marked, fluxes, duration, substeps=2)
    np.testing.assert_allclose(after.sum(axis=1), marked.sum(axis=1), rtol=1e-12)
    assert (after >= 0).all()


def test_rates_by_hand():
    # 2 m3/s from the left cell of 4 m3 to the right; 3 m3/s down into the left one
    rates = generator(np.array([[4.0, 8.0], [6.0, 1.0]]), np.array([[2.0], [0.0]]), np.array([[-3.0, 0.0]]))
    expected = np.zeros((4, 4))
    expected[0, :2] = -0.5, 0.5
    expected[2, [2, 0]] = -0.5, 0.5
    np.testing.assert_allclose(rates.toarray(), expected)


def test_a_roll_keeps_what_is_on_no_line_of_flow_across():
    # a roll through the four cells; the sides are left and right, and both halves of the roll are alike
    contents = np.ones((2, 2))
    roll = Fluxes(contents, contents, np.array([[-1.0], [1.0]]), np.array([[1.0, -1.0]]))
    sides = np.array([[1.0, 0, 1, 0], [0, 1.0, 0, 1]])
    curves = remaining(contents, lambda _: roll, 200, 0.05, sides)
    assert curves[0] == pytest.approx([1, 1])
    assert (np.diff(curves[:20], axis=0) < 0).all()
    np.testing.assert_allclose(curves[-1], 0.5, atol=1e-3)


def test_an_empty_cell_holds_next_to_nothing():
    assert contents_of(np.array([0.0, 0.5]), 2.0) == pytest.approx([2e-9, 1.0])
