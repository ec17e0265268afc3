# SPDX-License-Identifier: GPL-3.0-or-later
"""Marks: each with a name and a rule of its own."""

import pytest

from bedchain.case.load import load_case
from bedchain.errors import CaseError
from made.case_text import assert_refused, changed_case

PLACE = "split_z_m: 0.081"
GOOD = [
    "{name: small, types: [1]}",
    "{name: core, ring: {radius_m: 0.02}}",
    "{name: lower, plane: {normal: [0, 0, 1], offset_m: 0.05}}",
    "{name: fine, diameter_below_m: 0.002}",
    "{name: dyed, ids: dyed.txt}",
]
MISTAKES = [
    ("[{name: a}]", "a has no rule; give it one of plane, ring"),
    ("[{name: a, types: [1], ids: b.txt}]", "a has types and ids"),
    ("[{name: a, types: [1]}, {name: a, types: [2]}]", "2 marks are called a"),
    ("[{name: a, plane: {normal: [0, 0, 0], offset_m: 1}}]", "a plane of normal 0, 0, 0"),
]


def with_marks(folder, marks):
    return changed_case(folder, (PLACE, f"{PLACE}\nmarks: {marks}"))


@pytest.mark.parametrize(("marks", "message"), MISTAKES)
def test_a_mistake_is_refused(tmp_path, marks, message):
    assert_refused(with_marks(tmp_path, marks), "marks", message)


def test_marks_of_every_kind_are_taken(tmp_path):
    assert len(load_case(with_marks(tmp_path, f"[{', '.join(GOOD)}]"))["marks"]) == len(GOOD)


@pytest.mark.parametrize("mark", ["{name: a, typ: [1]}", "{name: '', types: [1]}", "{name: a, ring: {}}"])
def test_the_schema_refuses_unknown_and_missing_keys(tmp_path, mark):
    with pytest.raises(CaseError, match="marks"):
        load_case(with_marks(tmp_path, f"[{mark}]"))
