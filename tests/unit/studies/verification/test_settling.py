# SPDX-License-Identifier: GPL-3.0-or-later
"""Theory of a lone falling sphere: Stokes's exponential, free fall at first, and its end."""

import math

import numpy as np
import pytest

from bedchain.studies.verification.laws import LAWS, Suspension, drag_coefficient
from bedchain.studies.verification.settling import ALONE, falling_speed, terminal_speed


def test_a_small_sphere_falls_as_stokes_says():
    small = Suspension(1e-5, 1000.0, 1.2, 1.8e-5)
    terminal = 998.8 * 9.81 * 1e-10 / (18 * 1.8e-5)
    relaxation = 1000.0 * 1e-10 / (18 * 1.8e-5)
    times = np.linspace(0, 5, 11) * relaxation
    expected = terminal * (1 - np.exp(-times / relaxation))
    # Reynolds number 0.002: Schiller and Naumann's factor is 1.002
    assert falling_speed(LAWS["wen_yu"], small, times) == pytest.approx(expected, rel=4e-3)
    assert terminal_speed(LAWS["wen_yu"], small) == pytest.approx(terminal, rel=4e-3)


@pytest.mark.parametrize("law", sorted(LAWS))
def test_a_large_sphere_falls_freely_at_first_and_is_carried_in_the_end(law):
    of = Suspension(1e-3, 1000.0, 1.2, 1.8e-5)
    speed = falling_speed(LAWS[law], of, np.array([0.0, 1e-3, 20.0]))
    assert speed[1] == pytest.approx(9.81e-3 * (1 - 1.2 / 1000), rel=5e-3)
    terminal = terminal_speed(LAWS[law], of)
    assert speed[2] == pytest.approx(terminal, rel=1e-6)
    drag = drag_coefficient(LAWS[law], of, ALONE, terminal) * terminal
    assert drag == pytest.approx(998.8 * math.pi / 6 * 1e-9 * 9.81)
