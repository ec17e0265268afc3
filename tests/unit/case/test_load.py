# SPDX-License-Identifier: GPL-3.0-or-later
"""Case files: the shipped ones, defaults, and every kind of mistake in one clear message."""

import re
from pathlib import Path

import pytest

from bedchain.case.load import load_case
from bedchain.case.schema import case_value, load_schema, schema_keys
from bedchain.case.strict_yaml import read_yaml
from bedchain.errors import CaseError, UserError, report_user_errors
from bedchain.physics.contacts import rayleigh_time
from bedchain.physics.fluidization import courant_number
from bedchain.physics.packing import settled_height, start_height
from bedchain.physics.whole_numbers import is_multiple, is_prime
from made import ROOT

CASE = """\
title: a small bed
seed: 15485863
bed:
  width_m: 0.09
  height_m: 0.45
particles:
  number: 7200
time:
  end_s: 5.0  # simulated
learning:
  start_s: 1.0
  end_s: 3.0
comparison:
  start_s: 3.0
  end_s: 5.0
cells:
  columns: 10
  rows: 50
mixing:
  split_z_m: 0.081
figures:
  batch_height_m: 0.027
"""
# the design page gives the step with three digits
DESIGN_DIGITS = 2e-3


@pytest.fixture
def changed(tmp_path):
    """A good case with one text replaced by another; it must be there exactly once."""

    def change(*replacements: tuple[str, str]) -> Path:
        text = CASE
        for old, new in replacements:
            assert text.count(old) == 1, f"{old!r} is {text.count(old)} times in CASE"
            text = text.replace(old, new)
        file = tmp_path / "case.yaml"
        file.write_text(text, encoding="utf-8")
        return file

    return change


def problem_of(file: Path, key: str):
    with pytest.raises(CaseError) as caught:
        load_case(file)
    found = [problem for problem in caught.value.problems if problem.key == key]
    assert found, f"no problem with {key} in: {caught.value}"
    assert str(file) in str(caught.value)
    return found[0]


@pytest.mark.parametrize("name", ["short", "paper", "mueller", "drum"])
def test_shipped_cases_load_with_every_key(name):
    case = load_case(ROOT / "cases" / name / "case.yaml")
    for key in schema_keys(load_schema()):
        if key == "preset" or (key.startswith("drum.") and name != "drum"):
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


def test_every_key_of_the_schema_says_meaning_unit_and_source():
    for key, part in schema_keys(load_schema()).items():
        description = part["description"]
        assert re.search(r"\[[^\]]+\]", description), f"{key}: no [unit]"
        source = "Table 1|[Ss]ection|Our choice|[Oo]ur choice|paper|Figs"
        assert re.search(source, description), f"{key}: no source"


def test_every_object_of_the_schema_refuses_unknown_keys():
    def walk(part):
        if part.get("type") == "object":
            assert part["additionalProperties"] is False
            for inner in part["properties"].values():
                walk(inner)

    walk(load_schema())


def test_defaults_and_derived_defaults_are_filled_in(changed):
    case = load_case(changed(("height_m: 0.45", "height_m: 0.5")))
    assert case["bed"]["thickness_m"] == case["particles"]["diameter_m"] == 1e-3
    assert case["mixing"]["split_x_m"] == pytest.approx(0.045)
    assert case["contact"]["restitution_1"] == 0.9


@pytest.mark.parametrize("text", ["2e-5", "2E-5", "0.00002", "2.0e-5", "+.2e-4"])
def test_numbers_are_read_as_numbers_in_every_spelling(changed, text):
    case = load_case(
        changed(("  end_s: 5.0  # simulated", f"  dem_step_s: {text}\n  end_s: 5.0  # simulated"))
    )
    assert case["time"]["dem_step_s"] == 2e-5


def test_whole_numbers_become_float_and_int_as_the_schema_says(changed):
    case = load_case(changed(("number: 7200", "number: 7.2e3"), ("  end_s: 5.0  # simulated", "  end_s: 5")))
    assert isinstance(case["particles"]["number"], int)
    assert isinstance(case["time"]["end_s"], float)


MISTAKES = [
    # replaced, by, key named, in the message
    ("width_m: 0.09", "widht_m: 0.09", "bed.widht_m", "width_m"),
    ("height_m: 0.45", "height_m: 0.45\n  dem_step_s: 1e-5", "bed.dem_step_s", "time.dem_step_s"),
    ("seed: 15485863", "seed: 15485863\nzzz: 1", "zzz", "known here"),
    ("width_m: 0.09", "thickness_m: 0.001", "bed.width_m", "add it"),
    ("number: 7200", "number: 7200\n  diameter_m: -1.0e-3", "particles.diameter_m", "above 0"),
    ("number: 7200", "number: many", "particles.number", "integer"),
    ("number: 7200", "number: 7200.5", "particles.number", "integer"),
    ("number: 7200", "number: true", "particles.number", "integer"),
    ("number: 7200", "number: 90000", "particles.number", "at most"),
    ("width_m: 0.09", "width_m: 9.0e-4", "bed.width_m", "narrower than a particle"),
    ("width_m: 0.09", "width_m: 0.09\n  layers: two", "bed.layers", "one, many"),
    ("width_m: 0.09", "width_m: 0.09\n  thickness_m: 7.0e-4", "bed.thickness_m", "narrower than a particle"),
    (
        "width_m: 0.09",
        "width_m: 0.09\n  layers: many\n  thickness_m: 1.1e-3",
        "bed.thickness_m",
        "narrower than the lattice",
    ),
    (
        "width_m: 0.09\n  height_m: 0.45\nparticles:\n  number: 7200",
        "width_m: 0.09\n  height_m: 0.45\n  layers: many\n  thickness_m: 0.01\nparticles:\n  number: 400000",
        "particles.number",
        "take at most",
    ),
    ("width_m: 0.09", "width_m: .inf", "bed.width_m", "finite"),
    ("seed: 15485863", "seed: 15485864", "seed", "15485867"),
    ("seed: 15485863", "seed: 9973", "seed", "above 10000"),
    ("seed: 15485863", "seed: 4294967311", "seed", "31 bits"),
    (
        "  end_s: 5.0  # simulated",
        "  dem_step_s: 5e-5\n  end_s: 5.0  # simulated",
        "time.dem_step_s",
        "allow_unstable_step",
    ),
    (
        "  end_s: 5.0  # simulated",
        "  dem_step_s: 1.5e-5\n  end_s: 5.0  # simulated",
        "time.gas_step_s",
        "multiple of time.dem_step_s",
    ),
    (
        "  end_s: 5.0  # simulated",
        "  gas_step_s: 1e-2\n  end_s: 5.0  # simulated",
        "time.gas_step_s",
        "Courant",
    ),
    (
        "  end_s: 5.0  # simulated",
        "  gas_step_s: 3e-4\n  end_s: 5.0  # simulated",
        "time.frame_interval_s",
        "multiple of time.gas_step_s",
    ),
    (
        "  end_s: 5.0  # simulated",
        "  frame_interval_s: 0.02501\n  end_s: 5.0  # simulated",
        "time.frame_interval_s",
        "multiple",
    ),
    (
        "  end_s: 5.0  # simulated",
        "  segment_s: 0.51\n  end_s: 5.0  # simulated",
        "time.segment_s",
        "take 0.5",
    ),
    ("  end_s: 5.0  # simulated", "  ramp_s: 5.0\n  end_s: 5.0  # simulated", "time.ramp_s", "not before"),
    ("  end_s: 5.0  # simulated", "  end_s: 4.0", "comparison.end_s", "raise time.end_s to 5"),
    ("  start_s: 1.0", "  start_s: 3.5", "learning.end_s", "not after"),
    ("  start_s: 1.0", "  start_s: 1.01", "learning.start_s", "multiple of time.frame_interval_s"),
    ("comparison:\n  start_s: 3.0", "comparison:\n  start_s: 2.0", "comparison.start_s", "at least 3"),
    ("columns: 10", "columns: 91", "cells.columns", "at most 90"),
    ("split_z_m: 0.081", "split_z_m: 0.5", "mixing.split_z_m", "outside the bed"),
    ("split_z_m: 0.081", "split_z_m: 0.081\nchain:\n  lag_s: 0.03", "chain.lag_s", "take 0.025"),
    (
        "split_z_m: 0.081",
        "split_z_m: 0.081\nchain:\n  models: [statik]",
        "chain.models[0]",
        "static, dynamic",
    ),
    (
        "split_z_m: 0.081",
        "split_z_m: 0.081\ngas:\n  cell_size_m: 0.004",
        "gas.cell_size_m",
        "does not divide",
    ),
    ("split_z_m: 0.081", "split_z_m: 0.081\ngas:\n  drag_law: stokes", "gas.drag_law", "gidaspow"),
    ("split_z_m: 0.081", "split_z_m: 0.081\ngas:\n  cell_size_m: 0.01", "run.ranks", "take run.ranks: 1"),
    ("batch_height_m: 0.027", "moments_s: [0.05, 2.05]", "figures.moments_s", "after the end"),
    ("batch_height_m: 0.027", "dem_colour: '12'", "figures.dem_colour", "Matplotlib"),
]


@pytest.mark.parametrize(("old", "new", "key", "said"), MISTAKES)
def test_a_mistake_is_refused_with_key_line_and_remedy(changed, old, new, key, said):
    file = changed((old, new))
    problem = problem_of(file, key)
    assert said in f"{problem.wrong}; {problem.remedy}"
    lines = file.read_text(encoding="utf-8").splitlines()
    if problem.line is not None and "missing" not in problem.wrong:
        assert key.split(".")[-1].split("[")[0] in lines[problem.line - 1]


def test_all_mistakes_are_told_at_once(changed):
    file = changed(("seed: 15485863", "seed: 15485864"), ("width_m: 0.09", "widht_m: 0.09"), ("7200", "-1"))
    with pytest.raises(CaseError) as caught:
        load_case(file)
    keys = {problem.key for problem in caught.value.problems}
    assert keys == {"seed", "bed.widht_m", "bed.width_m", "particles.number"}


def test_the_explicit_key_allows_an_unstable_step(changed):
    file = changed(
        (
            "  end_s: 5.0  # simulated",
            "  dem_step_s: 5e-5\n  allow_unstable_step: true\n  end_s: 5.0  # simulated",
        )
    )
    assert load_case(file)["time"]["dem_step_s"] == 5e-5


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "seed: 1\nbed:\n  width_m: 1\n  width_m: 2\n",
            "line 4, bed.width_m: is there twice, first in line 3",
        ),
        ("a: [1\nb: 2\n", "no YAML"),
        ("", "holds no keys"),
        ("a: &x {b: 1}\nc: *x\n", "alias"),
    ],
)
def test_a_file_that_is_no_clean_yaml_is_refused(tmp_path, text, said):
    file = tmp_path / "case.yaml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        load_case(file)
    assert said in str(caught.value)


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(UserError, match=r"none\.yaml"):
        read_yaml(tmp_path / "none.yaml")


def test_rayleigh_time_as_on_the_design_page():
    assert 0.2 * rayleigh_time(5e6, 0.3, 2600, 5e-4) == pytest.approx(1.25e-5, rel=DESIGN_DIGITS)


def test_rayleigh_time_by_hand():
    # G = 2 (1 + 0) / (2 (1 + 0)) = 1 Pa, so pi * 1 * sqrt(4 / 1) / 0.8766
    assert rayleigh_time(2.0, 0.0, 4.0, 1.0) == pytest.approx(2 * 3.141592653589793 / 0.8766, rel=1e-15)


def test_small_checks_by_hand():
    assert is_multiple(0.025, 2e-5) and is_multiple(0.3, 0.1)
    assert not is_multiple(0.025, 1.2e-5) and not is_multiple(0.0, 0.1)
    assert [number for number in range(30) if is_prime(number)] == [2, 3, 5, 7, 11, 13, 17, 19, 23, 29]
    assert courant_number(1.5, 2e-4, 5e-3) == pytest.approx(0.15)
    assert settled_height(82, 2.0, 3.141592653589793) == pytest.approx(100.0)
    # 6 of diameter 1 have the volume pi, at 0.6 in a section of 1 by 1
    assert settled_height(6, 1.0, 1.0, 1.0) == pytest.approx(3.141592653589793 / 0.6)
    # spacing 1.15: 8 columns of 10 / 8 = 1.25, 4 layers in 5: 33 need two rows
    assert start_height(32, 1.0, 10.0, 5.0) == 1.25 and start_height(33, 1.0, 10.0, 5.0) == 2.5


def test_a_user_error_is_one_message_and_exit_code_1(capsys, tmp_path):
    with pytest.raises(SystemExit) as caught, report_user_errors(tmp_path / "log"):
        raise UserError("the disk is full; free some space")
    assert caught.value.code == 1
    assert capsys.readouterr().err == "error: the disk is full; free some space\n"
    assert (tmp_path / "log").read_text(encoding="utf-8") == "error: the disk is full; free some space\n"


def test_other_errors_pass_unchanged():
    with pytest.raises(ZeroDivisionError), report_user_errors():
        raise ZeroDivisionError
