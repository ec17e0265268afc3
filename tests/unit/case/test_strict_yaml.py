# SPDX-License-Identifier: GPL-3.0-or-later
"""YAML files read strictly: numbers in every spelling, and every fault in one message."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

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
        ("a: 1\nb: 2001-02-30\n", "line 2, b: 2001-02-30 cannot be read as timestamp"),
        ("a: 0x_\n", "line 1, a: 0x_ cannot be read as int"),
        ("a: !!bool perhaps\n", "line 1, a: perhaps cannot be read as bool"),
        ("a: 1\n\nb: \a\n", "line 3, (file): no YAML: the character '\\x07' is not allowed"),
        ('a: 1\nb: "\\UFFFFFFFF"\n', "line 2, (file): no YAML"),
        ("a: " + "[" * 2000, "line 1, (file): no YAML: its groups are nested too deeply"),
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


# pieces that mean something in YAML, and what may stand between them
PIECES = st.sampled_from(
    ["a", "b: ", "- ", "\n", "\n  ", "1", "-.5e3", "0x", "0b", ":", ": ", "? ", "&x ", "*x", "!!int ",
     "!!bool ", "[", "]", "{", "}", ",", "'", '"', "#", "|", ">", "%", "---", "...", "<<: ", "~",
     "2001-13-41", "12:60", "\\", "\t", "\u2028", "\0"]
)  # fmt: skip


@settings(max_examples=150)
@given(st.one_of(st.lists(PIECES, max_size=25).map("".join), st.text(max_size=40)))
def test_any_text_is_a_value_or_a_problem_with_a_line(tmp_path, text):
    file = tmp_path / "any.yaml"
    file.write_bytes(text.encode("utf-8", "surrogatepass"))
    try:
        _, lines = read_yaml(file)
    except CaseError as error:
        assert all(problem.line > 0 for problem in error.problems)
    except UserError as error:
        assert "cannot be read" in str(error)
    else:
        assert all(line > 0 for line in lines.values())
