# SPDX-License-Identifier: GPL-3.0-or-later
"""The bed of parcels: its numbers, and what stays."""

import math

import pytest

from bedchain.case.load import load_case
from bedchain.case.parameters import SKIN_LEAST, solver_parameters, weight_per_area
from bedchain.case.parcels import parcel_case, particles_per_parcel
from bedchain.case.scene import scene_of
from bedchain.case.schema import load_schema
from bedchain.physics.contacts import rayleigh_time, static_overlap
from made.case_text import changed_case

NUMBER = "number: 7200"
THICK = "height_m: 0.45\n  layers: many\n  thickness_m: 0.012"


def case_of(folder, size, *changes):
    return load_case(changed_case(folder, (NUMBER, f"number: 7200\n  parcel_diameters: {size}"), *changes))


def given(case):
    return {part.name: part.value for part in solver_parameters(case, load_schema())}


def test_single_particles_are_as_they_were(tmp_path):
    case = case_of(tmp_path, 1)
    assert parcel_case(case) is case
    assert given(case) == given(load_case(changed_case(tmp_path)))
    assert given(case)["particle_diameter"] == given(case)["diameter"]


def test_parcels_of_one_layer_make_a_slab_as_much_thicker(tmp_path):
    case = case_of(tmp_path, 2)
    values = given(case)
    assert (values["number"], particles_per_parcel(case)) == (1800, 4)
    assert (values["diameter"], values["particle_diameter"], values["thickness"]) == (2e-3, 1e-3, 2e-3)
    assert (values["slab_low"], values["slab_high"], values["skin"]) == (-1e-3, 1e-3, 2e-3 * SKIN_LEAST)
    assert values["restitution"] == pytest.approx(math.sqrt(0.62))
    assert (values["dem_step"], values["coupling_steps"]) == (3.125e-5, 16)
    for name in ("young", "friction", "density", "superficial_velocity", "gas_step", "smoothing_diameters"):
        assert values[name] == given(parcel_case(case))[name] == given(case_of(tmp_path, 1))[name]


def test_parcels_of_a_thick_bed_are_fewer_by_their_volume(tmp_path):
    values = given(case_of(tmp_path, 2, ("height_m: 0.45", THICK)))
    assert (values["number"], values["thickness"]) == (900, 0.012)


@pytest.mark.parametrize("thick", [False, True])
def test_weight_depth_and_overlap_of_the_bed_stay(tmp_path, thick):
    changes = (("height_m: 0.45", THICK),) if thick else ()
    case = case_of(tmp_path, 2, *changes)
    parcels = parcel_case(case)
    assert weight_per_area(parcels) == pytest.approx(weight_per_area(case), rel=1e-12)
    assert scene_of(parcels).depth == pytest.approx(scene_of(case).depth, rel=1e-12)
    overlaps = [
        static_overlap(
            1e6, 0.3, 2600, bed["particles"]["diameter_m"], bed["particles"]["number"], bed["bed"]["width_m"],
            bed["bed"]["thickness_m"],
        )
        for bed in (case, parcels)
    ]  # fmt: skip
    assert overlaps[0] == pytest.approx(overlaps[1], rel=1e-12)


@pytest.mark.parametrize(("size", "step"), [(2.0, 3.125e-5), (3.0, 5e-5), (1.5, 2.5e-5), (2.5, 5e-5)])
def test_the_step_grows_as_far_as_it_divides_the_gas_step(tmp_path, size, step):
    case = case_of(tmp_path, size)
    assert parcel_case(case)["time"]["dem_step_s"] == step
    assert step <= size * case["time"]["dem_step_s"]
    longest = rayleigh_time(1.9e6, 0.3, 2600, size * 0.5e-3)
    assert step <= 0.2 * longest
