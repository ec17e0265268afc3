# SPDX-License-Identifier: GPL-3.0-or-later
"""Names that reach file names and a shell: of cases and presets, the good, the bad and the taken."""

import pytest

from bedchain.case.names import RESERVED, case_name_problem, is_name

GOOD = ["short", "2024", "2024_11_25", "my-bed.v2", "_x", "7", "A.B-c_9", "1e5"]
BAD = [
    "",
    "my bed",
    "it's",
    "a&b",
    "{b}",
    "#x",
    "$(touch x)",
    "`x`",
    "a;b",
    "a|b",
    "a\nb",
    "a\n",
    ".",
    "..",
    ".x",
    "-x",
]
BAD += ["a/b", "../x", "bed\0", "bédé", "a*", "a?", "~", "a=b", "a,b", "%s", "a\\b", '"', "!x", "٣"]


@pytest.mark.parametrize("name", GOOD)
def test_letters_digits_dot_underscore_and_hyphen_make_a_name(name):
    assert is_name(name) and case_name_problem(name, [name], ["fast"]) is None


@pytest.mark.parametrize("name", BAD)
def test_any_other_name_is_refused_in_one_line_with_the_rule(name):
    assert not is_name(name)
    message = case_name_problem(name, [name], ["fast"])
    assert repr(name) in message and "letters, digits, '.', '_' and '-'" in message and "\n" not in message


@pytest.mark.parametrize("name", sorted(RESERVED))
def test_a_name_whose_results_are_those_of_a_study_is_refused(name):
    assert f"results/{name} belongs to" in case_name_problem(name, [name], [])


def test_a_name_whose_results_are_those_of_another_case_with_a_preset_is_refused():
    cases = ["short", "short-fast"]
    assert "short with the preset fast" in case_name_problem("short-fast", cases, ["fast"])
    assert case_name_problem("short", cases, ["fast"]) is None
    assert case_name_problem("short-fast", ["short-fast"], ["fast"]) is None
