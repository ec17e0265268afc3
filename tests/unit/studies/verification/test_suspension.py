# SPDX-License-Identifier: GPL-3.0-or-later
"""Theory of a sinking suspension."""

import numpy as np
import pytest

from bedchain.studies.verification.laws import LAWS, Suspension, drag_coefficient
from bedchain.studies.verification.suspension import LAW, VISCOSITY, sinking_speed

OF = Suspension(1e-3, 2600.0, 1.2, VISCOSITY)


@pytest.mark.parametrize("e", [0.6, 0.8])
def test_it_starts_with_the_weight_and_ends_where_drag_carries_it(e):
    speed = sinking_speed(OF, e, np.array([0.0, 1e-6, 1.0]))
    # the gas that must rise is heavier than it looks: all of it goes through the pores
    inertia = OF.mass + 1.2 * OF.volume * (1 - e) / e
    assert speed[1] == pytest.approx(OF.weight / inertia * 1e-6, rel=1e-3)
    # drag on slip w / e, and of it the share that the pressure does not carry
    slip = speed[2] / e
    assert drag_coefficient(LAWS[LAW], OF, e, slip) * slip / e == pytest.approx(OF.weight, rel=1e-5)


def test_a_closed_box_hinders():
    free, crowded = (sinking_speed(OF, e, np.array([0.0, 1.0]))[-1] for e in (0.95, 0.6))
    assert crowded < 0.3 * free
