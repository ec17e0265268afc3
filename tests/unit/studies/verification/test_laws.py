# SPDX-License-Identifier: GPL-3.0-or-later
"""Drag laws of the verification in their limits, and Ergun's pressure drop in both of its forms."""

import math

import pytest

from bedchain.studies.verification.laws import (
    LAWS,
    Suspension,
    drag_coefficient,
    ergun_beta,
    ergun_gradient,
    gidaspow_beta,
    minimum_fluidization,
    pressure_gradient,
    wen_yu_beta,
)

OF = Suspension(1e-3, 2600.0, 1.2, 1.8e-5)
SLOW = 1e-7  # [m/s], a Reynolds number of 7e-6


def test_a_sphere_by_hand():
    assert OF.volume == pytest.approx(5.2360e-10, rel=1e-4)
    assert OF.weight == pytest.approx(5.2360e-10 * 2598.8 * 9.81, rel=1e-4)
    assert OF.reynolds(-0.15) == pytest.approx(10.0) and OF.reynolds(0.0) > 0


@pytest.mark.parametrize("law", sorted(LAWS))
def test_one_slow_sphere_has_stokes_s_drag(law):
    # Di Felice's coefficient, Dalla Valle's, is 4.8^2 = 23.04 over Re in place of Stokes's 24
    # the blend has its arc tangent's share of Wen and Yu, and of Ergun's drag, which one sphere does not have
    shares = {"di_felice": 4.8**2 / 24, "gidaspow_blend": math.atan(150 * 1.75 * 0.2) / math.pi + 0.5}
    share = shares.get(law, 1.0)
    stokes = 3 * math.pi * OF.viscosity * OF.diameter
    assert drag_coefficient(LAWS[law], OF, 1 - 1e-7, SLOW) == pytest.approx(share * stokes, rel=6e-3)


@pytest.mark.parametrize("law", sorted(LAWS))
def test_drag_grows_with_slip_and_with_crowding(law):
    beta = [[LAWS[law](OF, e, slip) / (1 - e) for slip in (0.01, 0.3, 3.0)] for e in (0.95, 0.82, 0.6, 0.45)]
    assert all(a < b < c for a, b, c in beta)
    assert all(a < b for column in zip(*beta, strict=True) for a, b in zip(column, column[1:], strict=False))


def test_gidaspow_is_ergun_where_it_is_dense_and_wen_yu_where_it_is_not():
    assert gidaspow_beta(OF, 0.79, 0.5) == ergun_beta(OF, 0.79, 0.5)
    assert gidaspow_beta(OF, 0.8, 0.5) == wen_yu_beta(OF, 0.8, 0.5)


@pytest.mark.parametrize("e", [0.4, 0.6])
def test_ergun_s_pressure_drop_is_that_of_his_drag(e):
    assert pressure_gradient(ergun_beta, OF, e, 0.7) == pytest.approx(ergun_gradient(OF, e, 0.7))


def test_fine_powder_fluidizes_as_carman_and_kozeny_say():
    fine = Suspension(2e-5, 2600.0, 1.2, 1.8e-5)
    expected = 0.4**3 / (150 * 0.6) * 2598.8 * 9.81 * 4e-10 / 1.8e-5
    assert minimum_fluidization(fine, 0.4) == pytest.approx(expected, rel=1e-3)
