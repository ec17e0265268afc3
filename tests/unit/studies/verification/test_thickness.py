# SPDX-License-Identifier: GPL-3.0-or-later
"""Minimum fluidization of a lattice in slabs of several thicknesses."""

import pytest

from bedchain.dem.lattices import lattice
from bedchain.physics.fluidization import ergun_velocity
from bedchain.studies.verification.laws import Suspension
from bedchain.studies.verification.thickness import CELL, DIAMETER, WIDTH, fluidizing_speed

OF = Suspension(DIAMETER, 2600.0, 1.2, 1.8e-5)


@pytest.mark.parametrize("thickness", [0.82, 1.0, 1.25])
def test_even_rows_are_fluidized_by_ergun_at_their_voidage(thickness):
    z = lattice(WIDTH, 10 * CELL, DIAMETER, DIAMETER)[:, 1]
    voidage = 1 - 3.141592653589793 / 6 / thickness
    expected = ergun_velocity(voidage, DIAMETER, 2600.0, 1.2, 1.8e-5)
    assert fluidizing_speed(OF, z, thickness * DIAMETER) == pytest.approx(expected, rel=1e-9)
