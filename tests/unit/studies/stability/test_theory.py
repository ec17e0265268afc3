# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits by theory: waves of a lattice, oscillators, falls."""

import itertools
import math

import numpy as np
import pytest

from bedchain.case.bed_checks import OVERLAP_AT_REST_MAX
from bedchain.case.gas_checks import FREE_FALL_SHARE_MAX, GAS_CELL_MAX
from bedchain.physics.contacts import contact_modulus
from bedchain.studies.stability import theory
from bedchain.studies.stability.beds import StabilityBed, scene


def stiffest_wave(size=12):
    """Largest m omega^2 / k of a triangular lattice of masses and springs, by its dynamical matrix."""
    bonds = [(1.0, 0.0), (0.5, math.sqrt(3) / 2), (-0.5, math.sqrt(3) / 2)]
    largest = 0.0
    for i, j in itertools.product(range(size), repeat=2):
        # Wave vectors from the reciprocal lattice
        wave = 2 * math.pi / size * np.array([i, (2 * j - i) / math.sqrt(3)])
        matrix = sum(2 * (1 - math.cos(wave @ np.array(b))) * np.outer(b, b) for b in bonds)
        largest = max(largest, float(np.linalg.eigvalsh(matrix)[-1]))
    return largest


def test_the_stiffest_wave_of_closest_discs_is_that_of_the_lattice():
    assert stiffest_wave() == pytest.approx(theory.LATTICE_STIFFNESS)


def test_central_differences_diverge_just_above_the_oscillators_limit():
    bed = StabilityBed(young=1e6)
    small = scene(bed)
    limit = theory.oscillator_step(small, bed.number)
    omega = 2 / limit
    for share, grows in ((0.99, False), (1.01, True)):
        step, place, speed = share * limit, 1.0, 0.0
        for _ in range(2000):
            speed -= step * omega**2 * place
            place += step * speed
        assert (abs(place) > 1e3) == grows


def test_the_deepest_overlap_is_that_of_a_fall_of_one_diameter_where_particles_are_stiff():
    stiff = scene(StabilityBed(young=1e9))
    overlap = theory.deepest_overlap(stiff, 64) * stiff.diameter
    modulus = contact_modulus(stiff.young, stiff.poisson)
    stored = 8 / 15 * modulus * math.sqrt(stiff.diameter / 4) * overlap**2.5
    mass = stiff.density * math.pi / 6 * stiff.diameter**3
    assert stored == pytest.approx(mass / 2 * 9.81 * stiff.diameter / 2, rel=1e-3)
    soft = scene(StabilityBed(young=1e4))
    assert theory.deepest_overlap(soft, 64) == pytest.approx(3 * theory.overlap_at_rest(soft, 64))


def test_the_limits_of_the_checks_are_those_of_the_theory():
    bed = StabilityBed(young=5e3)
    assert theory.overlap_at_rest(scene(bed), bed.number) > OVERLAP_AT_REST_MAX
    assert theory.free_fall_limit(scene(StabilityBed()), 1e-3).value == pytest.approx(
        FREE_FALL_SHARE_MAX * math.sqrt(2 * 5e-3 / 9.81)
    )
    assert theory.density_limit(0.2).share == pytest.approx(2.0)
    still = theory.gas_step_limit(scene(StabilityBed(velocity=0.0)), 1e-3)
    assert still.formula.endswith("sqrt(2 cell / g)")
    fast = theory.gas_step_limit(scene(StabilityBed(velocity=5.0)), 1e-3)
    assert fast.share == pytest.approx(5.0 / 0.4 * 1e-3 / 5e-3)
    assert GAS_CELL_MAX == 0.5
