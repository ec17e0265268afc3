# SPDX-License-Identifier: GPL-3.0-or-later
"""YAML files read strictly: numbers in every spelling, and every fault in one message."""

import pytest

from bedchain.case.load import load_case
from bedchain.case.strict_yaml import read_yaml
from bedchain.errors import CaseError, UserError


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


@pytest.mark.parametrize("text", ["2e-5", "2E-5", "0.00002", "2.0e-5", "+.2e-4"])
def test_numbers_are_read_as_numbers_in_every_spelling(tmp_path, text):
    (tmp_path / "numbers.yaml").write_text(f"# a step\nstep_s: {text}\n")
    assert read_yaml(tmp_path / "numbers.yaml") == ({"step_s": 2e-5}, {"step_s": 2})
