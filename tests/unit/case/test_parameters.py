# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers that both solvers get, and the disk that they need."""

import copy
import math
import re

import pytest

from bedchain.case.load import load_case
from bedchain.case.parameters import (
    SKIN_LEAST,
    SKIN_MOST,
    fluidization_line,
    liggghts_text,
    openfoam_text,
    skin_diameters,
    solver_parameters,
)
from bedchain.case.schema import load_schema
from made import ROOT


@pytest.fixture
def values(paper):
    return {parameter.name: parameter.value for parameter in solver_parameters(paper, load_schema())}


def test_the_paper_s_numbers_arrive(values):
    assert (values["width"], values["height"], values["number"]) == (0.27, 1.05, 81000)
    assert (values["diameter"], values["radius"], values["density"]) == (1e-3, 5e-4, 2600)
    assert values["drag_law"] == "gidaspow"
    assert values["dump_suffix"] == "bin"


def test_the_skin_grows_with_the_root_of_the_step_within_limits():
    assert skin_diameters(9e-5, 1e-3) == pytest.approx(1.5 * skin_diameters(4e-5, 1e-3))
    assert skin_diameters(2e-4, 2e-3) == skin_diameters(1e-4, 1e-3)  # of parcels, that of their particles
    assert (skin_diameters(1e-6, 1e-3), skin_diameters(1.0, 1e-3)) == (SKIN_LEAST, SKIN_MOST)


def test_steps_and_cells_are_derived_as_whole_numbers(values):
    derived = {
        "gas_cells_x": 54,
        "gas_cells_y": 1,
        "gas_cells_z": 210,
        "coupling_steps": 16,
        "frame_steps": 800,
        "settle_steps": 16000,
    }
    for name, value in derived.items():
        assert values[name] == value and isinstance(values[name], int), name


def test_one_layer_has_no_walls_across_and_gas_in_two_dimensions(values):
    assert (values["depth_walls"], values["gas_cells_y"], values["faces_type"]) == (0, 1, "empty")


def test_many_layers_have_walls_and_whole_gas_cells_across():
    case = load_case(ROOT / "cases" / "mueller" / "case.yaml")

    def given():
        found = {parameter.name: parameter.value for parameter in solver_parameters(case, load_schema())}
        return [found[name] for name in ("depth_walls", "slab_high", "gas_cells_y", "faces_type")]

    assert given() == [1, 0.005, 4, "wall"]
    case["gas"]["cell_size_m"] = 0.011
    assert given() == [1, 0.005, 1, "empty"]


def test_rolling_resistance_is_on_where_it_has_a_coefficient(values, paper):
    assert (values["contact_law"], values["rolling_law"], values["rolling_friction"]) == ("hertz", "off", 0)
    paper["contact"]["rolling_friction_1"] = 0.01
    found = {parameter.name: parameter.value for parameter in solver_parameters(paper, load_schema())}
    assert (found["rolling_law"], found["rolling_friction"]) == ("epsd2", 0.01)


def test_lengths_of_time_that_may_grow_are_not_given_to_the_decks(values):
    assert not {"end", "end_time", "segment", "ranks"} & set(values)


def test_both_files_hold_the_same_numbers(paper):
    parameters = solver_parameters(paper, load_schema())
    decks = re.findall(r"^variable (\w+) (?:equal|string) (\S+)  # \[.+\] ", liggghts_text(parameters), re.M)
    dictionary = re.findall(r"^(\w+) (\S+); // \[.+\] ", openfoam_text(parameters), re.M)
    assert decks == dictionary == [(item.name, str(item.value)) for item in parameters]
    assert len({name for name, _ in decks}) == len(decks)


@pytest.mark.parametrize(
    ("section", "key", "value"),
    [
        ("figures", "dem_colour", "red"),
        ("cells", "columns", 54),
        ("time", "end_s", 30.0),
        ("learning", "start_s", 11.0),
        ("run", "ranks", 1),
    ],
)
def test_what_the_solvers_do_not_need_changes_nothing(paper, section, key, value):
    other = copy.deepcopy(paper)
    assert other[section][key] != value
    other[section][key] = value
    assert solver_parameters(other, load_schema()) == solver_parameters(paper, load_schema())


def test_the_drum_s_speed_reaches_the_decks_and_a_bed_in_a_box_has_none():
    speeds = {}
    for name in ("drum", "short"):
        case = load_case(ROOT / "cases" / name / "case.yaml")
        values = {item.name: item.value for item in solver_parameters(case, load_schema())}
        speeds[name] = values.get("drum_speed")
    assert speeds == {"drum": pytest.approx(2 * math.pi / 5.2, rel=1e-15), "short": None}


def test_a_case_is_told_what_its_thickness_does():
    line = fluidization_line(load_case(ROOT / "cases" / "short" / "case.yaml"))
    assert "0.77 m/s at T = 1 d (bed.thickness_m)" in line
    assert "0.46 m/s at T = 0.859 d (conversion of Hoomans et al. 1996)" in line
    many = fluidization_line(load_case(ROOT / "cases" / "mueller" / "case.yaml"))
    assert "at T" not in many and "u_mf about" in many
