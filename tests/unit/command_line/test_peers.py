# SPDX-License-Identifier: GPL-3.0-or-later
"""Options of the study peers: words of a shell line, and what is refused."""

import shlex

import pytest

from bedchain.command_line.peers import peers_options
from bedchain.errors import UserError

CASES = ["short", "paper"]


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
