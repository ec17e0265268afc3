# SPDX-License-Identifier: GPL-3.0-or-later
"""Rayleigh time and overlap at rest by hand."""

import math

import pytest

from bedchain.physics.contacts import contact_modulus, rayleigh_time, static_overlap

# the design page gives the step with three digits
DESIGN_DIGITS = 2e-3


def test_rayleigh_time_as_on_the_design_page():
    assert 0.2 * rayleigh_time(5e6, 0.3, 2600, 5e-4) == pytest.approx(1.25e-5, rel=DESIGN_DIGITS)


def test_rayleigh_time_by_hand():
    # G = 2 (1 + 0) / (2 (1 + 0)) = 1 Pa, so pi * 1 * sqrt(4 / 1) / 0.8766
    assert rayleigh_time(2.0, 0.0, 4.0, 1.0) == pytest.approx(2 * 3.141592653589793 / 0.8766, rel=1e-15)


def test_the_overlap_at_rest_carries_the_load_by_hertz():
    young, poisson, density, diameter, number, width = 2e6, 0.3, 2600.0, 1e-3, 300, 0.02
    overlap = static_overlap(young, poisson, density, diameter, number, width, diameter) * diameter
    force = 4 / 3 * contact_modulus(young, poisson) * math.sqrt(diameter / 4) * overlap**1.5
    layers = number * diameter / width
    assert force == pytest.approx(layers * density * math.pi / 6 * diameter**3 * 9.81)
    # Ten times as deep between its walls, with ten times as many particles
    deep = static_overlap(young, poisson, density, diameter, 10 * number, width, 10 * diameter) * diameter
    assert deep == pytest.approx(overlap)
