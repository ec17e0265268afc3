# SPDX-License-Identifier: GPL-3.0-or-later
"""Words of the command line: their values as they were typed, and safe in a shell line."""

import shlex

import pytest

from bedchain.command_line import as_typed, peers_options
from bedchain.errors import UserError

CASES = ["short", "paper"]


@pytest.mark.parametrize(
    "text", ["2024", "2024_11_25", "1e5", "0700", "007", "True", "nan", "1.50", "[a]", "{b: c}", "~"]
)
def test_what_looks_like_a_number_is_text_where_a_name_is_expected(text):
    parsed = {"case": 20241125, "preset": ["x=y"], "tradeoff": {"dem": "all"}}  # as snakemake reads them
    typed = [f"case={text}", "preset=x=y", "tradeoff={dem: all}"]
    assert as_typed(parsed, typed) == {"case": text, "preset": "x=y", "tradeoff": {"dem": "all"}}


def test_quotes_are_understood_as_before():
    assert as_typed({"case": "2024"}, ["case='2024'"]) == {"case": "2024"}


def test_the_case_of_the_paper_s_module_stays():
    assert as_typed({"case": "paper", "preset": "1"}, ["preset=1"]) == {"case": "paper", "preset": "1"}
    assert as_typed({"case": "short"}, None) == {"case": "short"}


def test_a_number_of_a_configuration_file_wants_quotes():
    with pytest.raises(UserError, match="case is 20241125, not text: put it in quotes"):
        as_typed({"case": 20241125}, None)


@pytest.mark.parametrize(
    ("option", "words"),
    [
        (None, []),
        ({}, []),
        ({"repeats": "5", "beds": "paper"}, ["--repeats", "5", "--beds", "paper"]),
        ({"beds": ["short", "paper"], "start": "0.1"}, ["--beds", "short", "paper", "--start", "0.1"]),
        ({"duration": 0.02, "longest": 1e3}, ["--duration", "0.02", "--longest", "1000.0"]),
    ],
)
def test_options_of_the_peers_are_words_of_a_shell(option, words):
    assert shlex.split(peers_options(option, CASES)) == words


@pytest.mark.parametrize(
    ("option", "message"),
    [
        ({"beds": "$(touch x)"}, "there is no case '$(touch x)'"),
        ({"beds": ["short", "papr"]}, "there is no case 'papr'; did you mean paper?"),
        ({"beds": []}, "peers.beds names no case"),
        ({"beds": {"a": "b"}}, "peers.beds"),
        ({"repeats": "2; touch x"}, "peers.repeats is '2; touch x', not a whole number above 0"),
        ({"repeats": "0"}, "peers.repeats"),
        ({"repeats": "1.5"}, "peers.repeats"),
        ({"duration": "nan"}, "peers.duration is 'nan', not a number above 0"),
        ({"start": ["1"]}, "peers.start"),
        ({"longest": "-1"}, "peers.longest"),
        ({"repeat": "2"}, "peers has no 'repeat'; did you mean repeats?"),
        ({"solver": "/bin/sh"}, "peers has no 'solver'"),
        ("all", "peers is 'all'"),
        (["a"], "peers is"),
    ],
)
def test_other_options_of_the_peers_are_refused(option, message):
    with pytest.raises(UserError) as caught:
        peers_options(option, CASES)
    assert message in str(caught.value)
