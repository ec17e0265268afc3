# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of a scene, against theory and by hand."""

import math
from dataclasses import replace

import pytest

from bedchain.physics import scene_numbers
from bedchain.studies.verification.laws import (
    Suspension,
    drag_coefficient,
    ergun_gradient,
    minimum_fluidization,
    wen_yu_beta,
)

SAME = 1e-9  # relative, of two ways to one root


@pytest.fixture(scope="module")
def spheres():
    return Suspension(1e-3, 2600, 1.2, 1.8e-5)


def bisect(rising, low, high):
    """Root of a rising function, by halving 200 times."""
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if rising(middle) < 0 else (low, middle)
    return low


def test_archimedes_number_of_the_paper_by_hand(scene):
    assert scene_numbers.archimedes(scene) == pytest.approx(1.2 * 2598.8 * 9.81 * 1e-9 / 3.24e-10, rel=SAME)


def test_ergun_velocity_carries_the_bed(scene, spheres):
    assert scene_numbers.ergun_velocity(scene) == pytest.approx(
        minimum_fluidization(spheres, scene.voidage), rel=1e-8
    )
    weight = (1 - scene.voidage) * 2598.8 * 9.81
    root = bisect(lambda speed: ergun_gradient(spheres, scene.voidage, speed) - weight, 0, 10)
    assert scene_numbers.ergun_velocity(scene) == pytest.approx(root, rel=SAME)
    there = replace(scene, velocity=scene_numbers.ergun_velocity(scene))
    assert scene_numbers.pressure_share(there) == pytest.approx(1, rel=SAME)


def test_the_design_s_velocities_of_fluidization(scene):
    # 0.77 m/s in the slab of one diameter, as design.md states
    assert scene_numbers.ergun_velocity(scene) == pytest.approx(0.77, abs=0.005)
    # Wen and Yu's own balance: Re^2 24.5 + 1652 Re = Ar
    re = scene_numbers.reynolds(scene, scene_numbers.wen_yu_velocity(scene))
    assert re**2 / 0.0408 + 2 * 33.7 / 0.0408 * re == pytest.approx(scene_numbers.archimedes(scene), rel=SAME)


@pytest.mark.parametrize("diameter", [1e-6, 1e-4, 1e-3, 2e-2])
def test_terminal_velocity_balances_the_drag_of_one_sphere(scene, diameter):
    one = Suspension(diameter, 2600, 1.2, 1.8e-5)
    dilute = 1 - 1e-12

    def surplus(speed):
        return drag_coefficient(wen_yu_beta, one, dilute, speed) * speed - one.weight

    speed = scene_numbers.terminal_velocity(replace(scene, diameter=diameter))
    # at 2 cm Newton's law: the tolerance is that of 1 - 1e-12 in double precision
    assert speed == pytest.approx(bisect(surplus, 0, 1e3), rel=1e-4)


def test_stokes_limit_of_the_terminal_velocity(scene):
    small = replace(scene, diameter=1e-6)
    stokes = 2598.8 * 9.81 * 1e-12 / (18 * 1.8e-5)
    assert scene_numbers.terminal_velocity(small) == pytest.approx(stokes, rel=1e-3)


def test_air_s_properties(scene):
    assert scene_numbers.sound_velocity(scene) == pytest.approx(343, abs=1.5)
    assert scene_numbers.free_path(scene) == pytest.approx(66e-9, abs=2e-9)


def test_collision_of_hertz_by_hand(scene):
    modulus, mass = 7.7e5 / 1.82, 2600 * math.pi / 12 * 1e-9
    speed = math.sqrt(9.81e-3)
    expected = 2.868 * (mass**2 / (2.5e-4 * modulus**2 * speed)) ** 0.2
    assert scene_numbers.contact_duration(scene) == pytest.approx(expected, rel=SAME)
