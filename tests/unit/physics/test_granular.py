# SPDX-License-Identifier: GPL-3.0-or-later
"""Granular pressure: its contact value, its slope, its limit of few particles."""

import numpy as np
import pytest

from bedchain.physics.granular import FRICTION_FROM, Granular

SOLIDS = Granular(2600.0, 0.8, 0.62)


def test_the_contact_value_is_the_one_of_the_cooling_tests():
    # Sinclair and Jackson with 0.62
    np.testing.assert_allclose(SOLIDS.contact_value(np.array([0.1, 0.3])), [2.19461, 4.65274], rtol=1e-5)
    assert SOLIDS.contact_value(np.array([0.6])) == SOLIDS.contact_value(np.array([FRICTION_FROM]))


def test_few_particles_have_the_pressure_of_an_ideal_gas():
    few = np.array([1e-4])
    assert SOLIDS.pressure_over_temperature(few)[0] == pytest.approx(2600 * 1e-4, rel=1e-3)


@pytest.mark.parametrize("solids", [0.05, 0.2, 0.45])
def test_the_slope_is_the_derivative_of_the_pressure(solids):
    step = 1e-6
    above, below = SOLIDS.pressure_over_temperature(np.array([solids + step, solids - step]))
    assert SOLIDS.pressure_slope(np.array([solids]))[0] == pytest.approx(
        (above - below) / (2 * step), rel=1e-6
    )
