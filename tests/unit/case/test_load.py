# SPDX-License-Identifier: GPL-3.0-or-later
"""Case files: the shipped ones, defaults, and every kind of mistake in one clear message."""

import pytest

from bedchain.case.load import load_case
from bedchain.case.schema import case_value, load_schema, schema_keys
from bedchain.errors import CaseError
from bedchain.physics.whole_numbers import is_multiple
from made import ROOT
from made.case_text import END, assert_refused, changed_case

ELSEWHERE = ("frames.", "network.", "scalar.")  # other sources than a simulation, or not asked
OPTIONAL = ("preset", "outside", "marks", "cells.layers", "cells.form", "cells.axis")


@pytest.mark.parametrize("name", ["short", "paper", "mueller", "mueller_06", "drum"])
def test_shipped_cases_load_with_every_key(name):
    case = load_case(ROOT / "cases" / name / "case.yaml")
    for key in schema_keys(load_schema()):
        if key in OPTIONAL or key.startswith(ELSEWHERE) or (key.startswith("drum.") and name != "drum"):
            continue  # of their own accord only
        assert case_value(case, key) is not None, key


def test_paper_case_has_all_the_values_of_the_paper():
    case = load_case(ROOT / "cases" / "paper" / "case.yaml")
    given = {key: part["x-paper"] for key, part in schema_keys(load_schema()).items() if "x-paper" in part}
    assert len(given) >= 15
    for key, value in given.items():
        section, _, last = key.rpartition(".")
        assert case[section][last] == value, key


@pytest.mark.parametrize("name", ["short", "paper", "mueller"])
def test_axial_groups_meet_between_two_rows(name):
    case = load_case(ROOT / "cases" / name / "case.yaml")
    assert is_multiple(case["mixing"]["split_z_m"] * case["cells"]["rows"], case["bed"]["height_m"])


def test_short_case_has_no_cell_in_two_groups():
    assert load_case(ROOT / "cases" / "short" / "case.yaml")["cells"]["columns"] % 2 == 0


def test_defaults_and_derived_defaults_are_filled_in(tmp_path):
    case = load_case(changed_case(tmp_path, ("height_m: 0.45", "height_m: 0.5")))
    assert case["bed"]["thickness_m"] == case["particles"]["diameter_m"] == 1e-3
    assert case["mixing"]["split_x_m"] == pytest.approx(0.045)
    assert case["contact"]["restitution_1"] == 0.9


def test_whole_numbers_become_float_and_int_as_the_schema_says(tmp_path):
    case = load_case(changed_case(tmp_path, ("number: 7200", "number: 7.2e3"), (END, "  end_s: 5")))
    assert isinstance(case["particles"]["number"], int)
    assert isinstance(case["time"]["end_s"], float)


MISTAKES = [
    # replaced, by, key named, in the message
    ("width_m: 0.09", "widht_m: 0.09", "bed.widht_m", "width_m"),
    ("height_m: 0.45", "height_m: 0.45\n  dem_step_s: 1e-5", "bed.dem_step_s", "time.dem_step_s"),
    ("seed: 15485863", "seed: 15485863\nzzz: 1", "zzz", "known here"),
    ("width_m: 0.09", "thickness_m: 0.001", "bed.width_m", "add it"),
    ("number: 7200", "number: 7200\n  diameter_m: -1.0e-3", "particles.diameter_m", "at least 1e-06"),
    ("number: 7200", "number: many", "particles.number", "integer"),
    ("number: 7200", "number: 7200.5", "particles.number", "integer"),
    ("number: 7200", "number: true", "particles.number", "integer"),
    ("width_m: 0.09", "width_m: 0.09\n  layers: two", "bed.layers", "one, many"),
    ("width_m: 0.09", "width_m: .inf", "bed.width_m", "finite"),
    (
        "split_z_m: 0.081",
        "split_z_m: 0.081\nchain:\n  models: [statik]",
        "chain.models[0]",
        "static, dynamic",
    ),
    ("split_z_m: 0.081", "split_z_m: 0.081\ngas:\n  drag_law: stokes", "gas.drag_law", "gidaspow"),
    ("batch_height_m: 0.027", "dem_colour: '12'", "figures.dem_colour", "Matplotlib"),
]


@pytest.mark.parametrize(("old", "new", "key", "message"), MISTAKES)
def test_a_mistake_is_refused_with_key_line_and_remedy(tmp_path, old, new, key, message):
    assert_refused(changed_case(tmp_path, (old, new)), key, message)


def test_all_mistakes_are_told_at_once(tmp_path):
    file = changed_case(
        tmp_path, ("seed: 15485863", "seed: 15485864"), ("width_m: 0.09", "widht_m: 0.09"), ("7200", "-1")
    )
    with pytest.raises(CaseError) as caught:
        load_case(file)
    keys = {problem.key for problem in caught.value.problems}
    assert keys == {"seed", "bed.widht_m", "bed.width_m", "particles.number"}
