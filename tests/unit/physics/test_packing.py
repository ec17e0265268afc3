# SPDX-License-Identifier: GPL-3.0-or-later
"""Voidage of a slab of one layer, heights of packed beds, Janssen's share of the walls."""

import math

import pytest

from bedchain.physics.packing import (
    LAYER_DISTANCE,
    converted_thickness,
    settled_height,
    slab_voidage,
    start_height,
    wall_share,
)

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


def test_heights_of_layers_and_boxes_by_hand():
    assert settled_height(82, 2.0, math.pi) == pytest.approx(100.0)
    # 6 of diameter 1 have the volume pi, at 0.6 in a section of 1 by 1
    assert settled_height(6, 1.0, 1.0, 1.0) == pytest.approx(math.pi / 0.6)
    # spacing 1.15: 8 columns of 10 / 8 = 1.25, 4 layers in 5: 33 need two rows
    assert start_height(32, 1.0, 10.0, 5.0) == 1.25 and start_height(33, 1.0, 10.0, 5.0) == 2.5


def test_wall_share_of_janssen():
    # the mean of exp(-j z) over the depth is what the floor carries
    steps = 100_000
    floor = sum(math.exp(-2.0 * (step + 0.5) / steps) for step in range(steps)) / steps
    assert wall_share(2.0) == pytest.approx(1 - floor, rel=1e-8)
    assert wall_share(0.0) == 0
    assert wall_share(1e-4) == pytest.approx(0.5e-4, rel=1e-3)
