# SPDX-License-Identifier: GPL-3.0-or-later
"""Words of --config: their values as they were typed; unknown ones, and values that cannot be, refused."""

import pytest
from snakemake.cli import parse_config

from bedchain.command_line.words import CHOICES, as_typed, check_words
from bedchain.errors import UserError
from made import ROOT
from made.refusals import message_of


@pytest.mark.parametrize(
    "text", ["2024", "2024_11_25", "1e5", "0700", "007", "True", "nan", "1.50", "[a]", "{b: c}", "~"]
)
def test_what_looks_like_a_number_is_text_where_a_name_is_expected(text):
    typed = [f"case={text}", "preset=x=y", "tradeoff={dem: all}"]
    assert as_typed(parse_config(typed), typed) == {"case": text, "preset": "x=y", "tradeoff": {"dem": "all"}}


def test_quotes_are_understood_as_before():
    assert as_typed({"case": "2024"}, ["case='2024'"]) == {"case": "2024"}


def test_the_case_of_the_paper_s_module_stays():
    assert as_typed({"case": "paper", "preset": "1"}, ["preset=1"]) == {"case": "paper", "preset": "1"}
    assert as_typed({"case": "short"}, None) == {"case": "short"}


def test_a_number_of_a_configuration_file_wants_quotes():
    with pytest.raises(UserError, match="case is 20241125, not text: put it in quotes"):
        as_typed({"case": 20241125}, None)


def parsed(typed):
    """Words of ``--config`` as a mapping."""
    return {key: value or None for key, value in (word.split("=", 1) for word in typed)}


@pytest.mark.parametrize(
    "typed",
    [
        [],
        ["case=paper", "preset=fast", "reference=simulate"],
        ["fidelity=fast"],
        ["stability=reduced"],
        ["tradeoff={dem: all}", "peers={beds: paper}"],
        ["study=verify"],
    ],
)
def test_known_words_pass(typed):
    check_words(parsed(typed), typed)
    check_words(parsed(typed) | {"studies": False}, typed)  # as the paper's module has them


@pytest.mark.parametrize(
    ("typed", "near"),
    [
        ("fidelty=fast", "did you mean ./run --config preset=fast?"),
        ("cas=paper", "did you mean ./run --config case=paper?"),
        ("Case=paper", "did you mean ./run --config case=paper?"),
        ("refrence=simulate", "did you mean ./run --config reference=simulate?"),
        ("tradeof={dem: all}", "did you mean ./run --config 'tradeoff={dem: all}'?"),
        ("studies=no", "did you mean ./run --config study=no?"),
        ("colour=red", "known are case, preset, reference, stability, tradeoff, peers, study"),
    ],
)
def test_an_unknown_word_is_refused_with_the_known_ones_and_a_near_guess(typed, near):
    message = message_of(check_words, parsed([typed]), [typed])
    assert f"--config has no word {typed.split('=')[0]!r}" in message and near in message


def test_an_unknown_word_of_a_configuration_file_is_refused():
    assert "no word 'cas'" in message_of(check_words, {"cas": "paper"}, None)


@pytest.mark.parametrize(
    ("typed", "message"),
    [
        (["case=a", "case=b"], "case is there twice"),
        (["preset=a", "fidelity=b"], "preset is there twice, once by its old name fidelity"),
        (["case="], "case= has no value"),
        (["tradeoff="], "tradeoff= has no value"),
        (["reference=simulated"], "reference=simulated: take archive or simulate; did you mean simulate?"),
        (["stability=short"], "stability=short: take full or reduced"),
        (["study=verfy"], "study=verfy: take "),
    ],
)
def test_a_word_given_twice_without_or_with_another_value_is_refused(typed, message):
    assert message in message_of(check_words, parsed(typed), typed)


def test_studies_are_those_of_write_readme():
    text = (ROOT / "scripts" / "write_readme.py").read_text(encoding="utf-8")
    block = text.split("OF_STUDY")[1].split("\n}\n")[0]
    assert {line.split('"')[1] for line in block.splitlines() if line.startswith('    "')} == {
        *CHOICES["study"]
    }
