# SPDX-License-Identifier: GPL-3.0-or-later
"""Theory of the contact checks: overlap by integrating the spring, rolling by integrating friction."""

import math

import numpy as np
import pytest

from bedchain.studies.verification import contacts


def squeezed(force, mass, speed):
    """Deepest overlap of two spheres that approach, by small steps."""
    step, overlap, deepest = 2e-8, 0.0, 0.0
    while speed > 0:
        speed -= step * force(overlap) / mass
        overlap += step * speed
        deepest = max(deepest, overlap)
    return deepest


def test_overlaps_are_those_of_springs():
    mass, radius = contacts.DENSITY * math.pi / 6 * contacts.SPHERE**3 / 2, contacts.SPHERE / 4
    hertz = 4 / 3 * contacts.MODULUS * math.sqrt(radius)
    deepest = squeezed(lambda overlap: hertz * max(overlap, 0) ** 1.5, mass, 2 * contacts.SPEED)
    assert contacts.deepest_overlap("hertz") == pytest.approx(deepest, rel=1e-3)
    # Hooke's spring goes as deep as Hertz's at sqrt(g W)
    slow = math.sqrt(9.81 * contacts.WIDTH)
    matched = squeezed(lambda overlap: hertz * max(overlap, 0) ** 1.5, mass, slow)
    assert contacts.deepest_overlap("hooke") == pytest.approx(matched * 2 * contacts.SPEED / slow, rel=1e-3)


@pytest.mark.parametrize("resistance", [0.0, contacts.ROLLING_FRICTION])
def test_a_sliding_sphere_is_braked_until_it_rolls(resistance):
    step, speed, surface, way = 1e-6, contacts.SLIDE_SPEED, 0.0, []
    for _ in range(int(contacts.SLIDE / step)):
        way.append(speed)
        if surface < speed:
            speed -= step * contacts.FRICTION * 9.81
            surface += step * 5 / 2 * (contacts.FRICTION - resistance) * 9.81
        else:
            speed -= step * 5 / 7 * resistance * 9.81
            surface = speed
    times = np.arange(len(way)) * step
    assert contacts.rolling_velocity(times, resistance) == pytest.approx(np.array(way), abs=1e-4 * way[0])
    if resistance == 0:
        assert way[-1] == pytest.approx(5 / 7 * way[0], rel=1e-3)
