# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases that can be one of two fluids, and the reason where they cannot."""

import pytest

from bedchain.case.load import load_case
from bedchain.case.two_fluid import is_two_fluid, two_fluid_case, two_fluid_grids
from bedchain.errors import CaseError, UserError
from made import ROOT

PAGE = """title: two fluids
seed: 15485863
bed: {width_m: 0.1, height_m: 0.4}
particles: {number: 9000}
gas: {model: two_fluid}
time: {end_s: 5.5}
learning: {start_s: 1.5, end_s: 3.5}
comparison: {start_s: 3.5, end_s: 5.5}
mixing: {split_z_m: 0.08}
"""


@pytest.fixture
def case():
    return load_case(ROOT / "cases" / "short" / "case.yaml")


def test_another_cell_gets_a_step_of_the_same_courant_number(case):
    two = two_fluid_case(case, 0.01)
    assert two["gas"]["cell_size_m"] == 0.01 and two["time"]["gas_step_s"] == pytest.approx(1e-3)
    assert two_fluid_case(case) == case
    case["particles"]["parcel_diameters"] = 2.0
    assert two_fluid_case(case)["particles"]["parcel_diameters"] == 1
    assert two_fluid_grids(case) == ["10", "5"]


@pytest.mark.parametrize(
    ("section", "key", "value", "said"),
    [
        ("bed", "layers", "many", "a bed of one layer with gas"),
        ("gas", "model", "none", "a bed of one layer with gas"),
        ("gas", "drag_law", "beetstra", "no drag law beetstra: take gas.drag_law gidaspow or wen_yu"),
        ("gas", "cell_size_m", 0.03, "cells of 0.03 m do not divide a bed of 0.1 x 0.4 m"),
    ],
)
def test_what_no_two_fluids_can_be_is_refused(case, section, key, value, said):
    case[section][key] = value
    with pytest.raises(UserError, match=said):
        two_fluid_case(case)
    assert two_fluid_grids(case) == []


def loaded(folder, text):
    (folder / "case.yaml").write_text(text)
    return load_case(folder / "case.yaml")


def test_a_case_of_two_fluids_is_one_as_it_stands(tmp_path):
    case = loaded(tmp_path, PAGE)
    assert is_two_fluid(case) and two_fluid_case(case) == case


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("9000}", "9000, parcel_diameters: 2}", "particles.parcel_diameters: belongs to particles"),
        ("mixing:", "chain: {lag_s: 0.05}\nmixing:", "chain: belongs to particles, and two fluids have none"),
        ("mixing:", "cells: {columns: 10, rows: 40}\nmixing:", "cells: belongs to particles"),
        ("mixing:", "drum: {revolution_s: 1}\nmixing:", "drum: belongs to particles"),
        ("{end_s: 5.5}", "{end_s: 5.5, dem_step_s: 2.0e-5}", "time.dem_step_s: belongs to particles"),
        ("5.5}\nmix", "5.5, repeats: 3}\nmix", "comparison.repeats: belongs to particles"),
        ("mixing:", "contact: {friction_1: 0.3}\nmixing:", "contact.friction_1: belongs to particles"),
        ("two_fluid}", "two_fluid, drag_law: beetstra}", "no drag law beetstra"),
        (
            "height_m: 0.4}",
            "height_m: 0.4, layers: many, thickness_m: 0.005}",
            "many is not possible for two",
        ),
        ("two_fluid}", "two_fluid, cell_size_m: 0.03}", "does not divide bed"),
    ],
)
def test_what_belongs_to_particles_is_refused(tmp_path, old, new, message):
    assert old in PAGE
    with pytest.raises(CaseError, match=message):
        loaded(tmp_path, PAGE.replace(old, new))
