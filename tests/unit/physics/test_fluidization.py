# SPDX-License-Identifier: GPL-3.0-or-later
"""The slab's thickness: voidage and minimum fluidization against closest packing and Ergun's equation."""

import math

import pytest

from bedchain.case.load import load_case
from bedchain.case.parameters import fluidization_line
from bedchain.physics.fluidization import ergun_velocity
from bedchain.physics.packing import LAYER_DISTANCE, converted_thickness, slab_voidage
from bedchain.studies.verification.laws import GRAVITY, Suspension, ergun_gradient
from made import ROOT

GLASS = (1e-3, 2600.0, 1.2, 1.8e-5)
CLOSEST_DISCS, CLOSEST_SPHERES = math.pi / (2 * math.sqrt(3)), math.pi / (3 * math.sqrt(2))


def test_a_cube_around_each_sphere_is_a_square_lattice_one_diameter_thick():
    assert slab_voidage(math.pi / 4, 1) == pytest.approx(1 - math.pi / 6)


def test_closest_discs_become_closest_spheres():
    assert slab_voidage(CLOSEST_DISCS, LAYER_DISTANCE) == pytest.approx(1 - CLOSEST_SPHERES)
    assert converted_thickness(CLOSEST_DISCS) == pytest.approx(LAYER_DISTANCE)


def test_the_conversion_is_that_of_hoomans():
    loose = 0.5
    expected = 1 - 2 / math.sqrt(math.pi * math.sqrt(3)) * loose**1.5
    assert slab_voidage(loose, converted_thickness(loose)) == pytest.approx(expected)


@pytest.mark.parametrize("voidage", [0.3, 0.4, 0.55])
def test_ergun_s_pressure_drop_carries_the_weight(voidage):
    speed = ergun_velocity(voidage, *GLASS)
    weight = (1 - voidage) * (GLASS[1] - GLASS[2]) * GRAVITY
    assert ergun_gradient(Suspension(*GLASS), voidage, speed) == pytest.approx(weight)


def test_a_case_is_told_what_its_thickness_does():
    line = fluidization_line(load_case(ROOT / "cases" / "short" / "case.yaml"))
    assert "0.77 m/s at T = 1 d (bed.thickness_m)" in line
    assert "0.46 m/s at T = 0.859 d (conversion of Hoomans et al. 1996)" in line
    many = fluidization_line(load_case(ROOT / "cases" / "mueller" / "case.yaml"))
    assert "at T" not in many and "u_mf about" in many
