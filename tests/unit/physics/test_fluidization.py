# SPDX-License-Identifier: GPL-3.0-or-later
"""Minimum fluidization against Ergun's equation, and the Courant number by hand."""

import pytest

from bedchain.physics.fluidization import courant_number, ergun_velocity
from bedchain.studies.verification.laws import GRAVITY, Suspension, ergun_gradient

GLASS = (1e-3, 2600.0, 1.2, 1.8e-5)


@pytest.mark.parametrize("voidage", [0.3, 0.4, 0.55])
def test_ergun_s_pressure_drop_carries_the_weight(voidage):
    speed = ergun_velocity(voidage, *GLASS)
    weight = (1 - voidage) * (GLASS[1] - GLASS[2]) * GRAVITY
    assert ergun_gradient(Suspension(*GLASS), voidage, speed) == pytest.approx(weight)


def test_courant_number_by_hand():
    # through a packed bed of voidage 0.4 the gas moves at 3.75 m/s: 0.75 mm of a cell of 5 mm
    assert courant_number(1.5, 2e-4, 5e-3) == pytest.approx(0.15)
