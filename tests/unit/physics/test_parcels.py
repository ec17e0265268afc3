# SPDX-License-Identifier: GPL-3.0-or-later
"""Parcels by hand: how many particles, which restitution."""

import math

import pytest

from bedchain.physics.parcels import parcel_restitution, particles_in


@pytest.mark.parametrize("restitution", [0.05, 0.3, 0.6, 0.8, 0.9, 0.97, 1.0])
def test_a_parcel_of_one_particle_is_the_particle(restitution):
    assert parcel_restitution(restitution, 1.0) == restitution
    assert particles_in(1.0, True) == particles_in(1.0, False) == 1


def test_a_parcel_loses_in_a_collision_what_its_particles_lose_in_theirs():
    assert parcel_restitution(0.9, 2.0) == pytest.approx(math.sqrt(1 - 2 * 0.19), rel=1e-14)
    assert parcel_restitution(1.0, 3.0) == 1.0
    assert math.isnan(parcel_restitution(0.5, 2.0))
    assert (particles_in(3.0, False), particles_in(3.0, True)) == (9, 27)
