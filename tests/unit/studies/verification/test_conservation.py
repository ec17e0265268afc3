# SPDX-License-Identifier: GPL-3.0-or-later
"""Energy of a heap, by hand."""

import math

import numpy as np
import pytest

from bedchain.studies.verification import conservation
from bedchain.studies.verification.laws import Suspension

MODULUS = conservation.YOUNG / (2 * (1 - 0.3**2))


def test_springs_of_a_pair_and_of_a_wall_hold_the_work_of_hertz_s_force():
    d, overlap = conservation.DIAMETER, 1e-5
    steps = np.linspace(0, overlap, 10_001)
    x, z = np.array([0.01, 0.01 + d - overlap]), np.full(2, 0.01)
    pair = np.trapezoid(4 / 3 * MODULUS * math.sqrt(d / 4) * steps**1.5, steps)
    assert conservation.elastic_energy(x, z) == pytest.approx(pair, rel=1e-6)
    # against a wall the radius of the contact is the sphere's own
    wall = np.trapezoid(4 / 3 * MODULUS * math.sqrt(d / 2) * steps**1.5, steps)
    assert conservation.elastic_energy(np.array([0.01]), np.array([d / 2 - overlap])) == pytest.approx(wall)
    assert conservation.elastic_energy(np.array([0.01, 0.012]), z) == 0


def test_a_fall_and_a_spin_turn_one_energy_into_another():
    of = Suspension(conservation.DIAMETER, 2600.0, 1.2, 1.8e-5)
    mass = 2600 * math.pi / 6 * 1e-9
    at_rest, falling = [1, 0.01, 0.02, 0, 0, 0], [1, 0.01, 0.02 - 9.81 / 2 * 0.01**2, 0, -9.81 * 0.01, 50.0]
    start, later = conservation.energies(np.array([[at_rest], [falling]]), of)
    assert start.tolist() == [0, 0, pytest.approx(mass * 9.81 * 0.02), 0]
    assert later[0] + later[2] == pytest.approx(start[2])
    assert later[1] == pytest.approx(0.5 * 0.4 * mass * (5e-4) ** 2 * 50**2)
