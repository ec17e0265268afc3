# SPDX-License-Identifier: GPL-3.0-or-later
"""Strict YAML: numbers, text, groups and characters that are no case, each refused by its line."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bedchain.case.load import load_case
from bedchain.case.presets import read_presets
from bedchain.case.strict_yaml import DEEPEST, read_yaml
from bedchain.errors import CaseError, UserError, report_user_errors

DEEP = 10_000


@pytest.fixture
def contents(tmp_path):
    """Contents of a YAML file of a text."""

    def read(text):
        file = tmp_path / "case.yaml"
        file.write_bytes(text if isinstance(text, bytes) else text.encode("utf-8"))
        return read_yaml(file)[0]

    return read


@pytest.fixture
def problem(contents):
    """The one problem of a file of that text."""

    def problem_of(text):
        with pytest.raises(CaseError) as caught:
            contents(text)
        (only,) = caught.value.problems
        return only

    return problem_of


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("0", 0), ("700", 700), ("-3", -3), ("+1", 1), ("1e5", 1e5), ("1E5", 1e5), ("2.5e-3", 2.5e-3),
        (".5", 0.5), ("-.5", -0.5), ("5.", 5.0), ("0.5", 0.5), ("1.9e+6", 1.9e6), ("0e0", 0.0),
    ],
)  # fmt: skip
def test_decimal_and_json_numbers_are_numbers(contents, text, number):
    value = contents(f"a: {text}\n")["a"]
    assert value == number and type(value) is type(number)


@pytest.mark.parametrize(
    "text",
    [
        *(
            "0700",
            "00",
            "-07",
            "0o17",
            "0x1F",
            "0b101",
            "1:30",
            "1:30.5",
            "190:20:30",
            "1_000",
            "1_0.5",
            "1_000e3",
        ),
        *("01.5", "1e", "e5", "1.2.3", ".", "+", "--1", "1 000", "1,5", "٣"),  # the last is an Arabic digit
    ],
)
def test_other_spellings_of_numbers_are_text(contents, text):
    assert contents(f"a: {text}\n") == {"a": text}


@pytest.mark.parametrize(
    "text", ["2024-11-25", "2024-13-45", "2024-11-25 12:00:00", "yes", "no", "On", "off", "=", "<<"]
)
def test_dates_and_words_of_the_old_yaml_are_text(contents, text):
    assert contents(f"a: {text}\n") == {"a": text}


def test_the_words_of_json_and_yaml_1_2_mean_what_they_say(contents):
    assert contents("[true, False, TRUE, null, ~, '5', \"1e5\"]") == [
        True,
        False,
        True,
        None,
        None,
        "5",
        "1e5",
    ]


@pytest.mark.parametrize("text", [".inf", "-.INF", ".nan", "1e400", "9" * 400, "9" * 5000, "-" + "9" * 400])
def test_numbers_that_are_not_finite_are_refused_by_line(problem, text):
    refused = problem(f"a: 1\nb: {text}\n")
    assert (refused.key, refused.line) == ("b", 2) and "not a finite number" in refused.wrong
    assert len(str(refused)) < 200


TAGGED = ["!!int 0700", "!!int abc", "!!float 1:30", "!!bool maybe", "!!timestamp x", "!!set {x}", "!mine 3"]
TAGGED += ["!!python/name:os.system x", "!!omap [a: 1]", "!!binary eA=="]


@pytest.mark.parametrize("text", TAGGED)
def test_tags_are_refused_by_line(problem, text):
    refused = problem(f"a: 1\nb: {text}\n")
    assert refused.line == 2 and "tag" in refused.wrong


def test_a_tag_for_text_is_text(contents):
    assert contents("a: !!str 5") == {"a": "5"}


@pytest.mark.parametrize("code", [0x00, 0x07, 0x1B, 0x7F])
def test_control_characters_are_refused_by_line(problem, code):
    refused = problem(f"a: 1\nb: x{chr(code)}y\n")
    assert refused.line == 2 and ascii(chr(code)) in refused.wrong


@pytest.mark.parametrize("escape", [r"\0", r"\x07", r"\ud800", r"\u009f"])
def test_escapes_of_control_characters_are_refused_by_line(problem, escape):
    refused = problem(f'a: 1\nb: "x{escape}y"\n')
    assert (refused.key, refused.line) == ("b", 2) and "character" in refused.wrong


def test_an_escape_beyond_unicode_is_refused_by_line(problem):
    assert problem('a: 1\nb: "\\U00110000"\n').line == 2


def test_bytes_that_are_no_text_are_refused_by_line(contents):
    with pytest.raises(UserError, match=r"line 2.*UTF-8"):
        contents(b"a: 1\nb: \xff\n")


@pytest.mark.parametrize(
    "text",
    [
        "[" * DEEP,
        "[" * DEEP + "]" * DEEP,
        "{a: " * DEEP + "1" + "}" * DEEP,
        "- " * DEEP + "1",
        "? " * DEEP + "1",
        "\n".join(" " * level + "a:" for level in range(200)),
    ],
    ids=["open lists", "lists", "groups", "items", "keys", "sections"],
)
def test_deep_nesting_is_one_error_by_line(problem, text):
    refused = problem("a: 1\nb:\n " + text.replace("\n", "\n ") + "\n")
    assert refused.line >= 3 and f"{DEEPEST} levels" in refused.wrong


@pytest.mark.parametrize("text", ["? [a]\n: 1\n", "{[a, b]: 1}", "? {a: 1}\n: 2\n"])
def test_a_key_that_is_no_word_is_refused_by_line(problem, text):
    refused = problem(text)
    assert refused.line == 1 and "key" in refused.wrong


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("a: 1\nb: [1, 2\n", 3),
        ("a: 1\n\tb: 2\n", 2),
        ("a: 1\nb: 'x\n", 3),
        ("a: 1\n---\nb: 2\n", 2),
        ("a: 1\nb: *c\n", 2),
        ("a: 1\nb: @x\n", 2),
        ("a: 1\nb: c: d\n", 2),
        ("a: 1\nb: &x [*x]\n", 2),
        ("a: 1\na: 2\n", 2),
        ("%YAML 9.9\n---\na: 1\n", 1),
    ],
)
def test_each_error_of_form_names_its_line(problem, text, line):
    assert problem(text).line == line


CASE = "title: {}\nseed: 15485863\nbed:\n  width_m: {}\n  height_m: 0.45\n"


@pytest.mark.parametrize("text", ["0700", "0o17", "1:30", "1_000", "0,09", "0.09 m"])
def test_a_case_refuses_them_where_a_number_is_expected(tmp_path, text):
    (tmp_path / "case.yaml").write_text(CASE.format("x", text))
    with pytest.raises(CaseError, match=rf"line 4, bed.width_m: '{text}' is not a number; .*0\.5 or 1\.5e-3"):
        load_case(tmp_path / "case.yaml")


def test_a_case_takes_them_where_text_is_expected(tmp_path):
    (tmp_path / "case.yaml").write_text(CASE.format("1:30", "0.09"))
    with pytest.raises(CaseError) as caught:
        load_case(tmp_path / "case.yaml")
    assert "title" not in {problem.key for problem in caught.value.problems}


def test_a_number_where_text_is_expected_wants_quotes(tmp_path):
    (tmp_path / "case.yaml").write_text(CASE.format("2024", "0.09"))
    with pytest.raises(CaseError, match=r"line 1, title: 2024 is not text; put it in quotes"):
        load_case(tmp_path / "case.yaml")


def test_presets_refuse_them_by_line(tmp_path, capsys):
    file = tmp_path / "presets.yaml"
    for value in ("0700", "1:30", "1_000"):
        file.write_text(f"fast:\n  cell_m: 0.02\n  lag_s: {value}\n  model: static\n")
        with pytest.raises(UserError, match=rf"presets.yaml, line 3, fast: lag_s is '{value}', not a number"):
            read_presets(file)
    file.write_text("fast:\n  cell_m: 0.02\n  lag_s: \0\n")
    with pytest.raises(SystemExit), report_user_errors():
        read_presets(file)
    assert "line 3" in capsys.readouterr().err


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
        ("a: 1\n\nb: \a\n", "line 3, (file): no YAML: the character '\\x07' is not allowed"),
        ('a: 1\nb: "\\UFFFFFFFF"\n', "line 2, (file): no YAML"),
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
