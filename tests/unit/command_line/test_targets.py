# SPDX-License-Identifier: GPL-3.0-or-later
"""Targets and options that snakemake would ignore or misread, refused with the line that was meant."""

import pytest

from bedchain.command_line.targets import check_options, check_targets
from bedchain.errors import UserError
from made.refusals import message_of

CASES = ["short", "paper"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ("--config case=paper --config preset=fast", "--config is there 2 times, and the last alone counts"),
        ("-C case=paper -n -Cpreset=fast", "--config is there 2 times"),
        ("--config=case=paper --config preset=fast", "--config is there 2 times"),
        ("--config", "--config has no key=value after it"),
        ("verify --config --dry-run", "--config has no key=value after it"),
        ("-C -n", "--config has no key=value after it"),
    ],
)
def test_a_config_that_would_be_ignored_is_refused(options, message):
    assert message in message_of(check_options, options.split(), 2, None)


@pytest.mark.parametrize(
    "options", ["", "verify -n", "--config case=a -n", "-Ccase=a", "-n -- --config", "--config=case=a"]
)
def test_other_options_pass(options):
    check_options(options.split(), 2, None)


@pytest.mark.parametrize(("cores", "jobs"), [(0, None), (-1, None), (None, 0), (2, 0)])
def test_no_cores_are_refused(cores, jobs):
    message = message_of(check_options, [], cores, jobs)
    assert "--cores" in message or "--jobs" in message
    check_options([], None, 20)


RULES = [
    "all",
    "verify",
    "validate",
    "tradeoff",
    "stability",
    "peers",
    "compare_peers",
    "readme",
    "estimate",
    "paper_all",
]


@pytest.mark.parametrize(
    "targets",
    [
        [],
        ["verify"],
        ["verify", "results/short/cells.npz"],
        ["results/short-fast/mixing.csv"],
        ["results/bin/bedFoam"],
        ["results/paper/cells.npz"],
        ["paper_all"],
        ["results/verify/verification.csv"],
        ["logs/x"],
    ],
)
def test_rules_and_files_of_the_run_pass_as_targets(targets):
    check_targets(targets, {}, RULES, CASES, {"short", "short-fast", "paper"})


@pytest.mark.parametrize(
    ("targets", "words", "message"),
    [
        (["paper"], {}, "'paper' is a case, no target; did you mean ./run --config case=paper?"),
        (["paper"], {"preset": "fast"}, "did you mean ./run --config preset=fast case=paper?"),
        (["verify", "paper"], {}, "did you mean ./run verify --config case=paper?"),
        (["case=paper"], {}, "'case=paper' is no target; did you mean ./run --config case=paper?"),
        (["cas=paper"], {}, "'cas=paper' is no target; did you mean ./run --config case=paper?"),
        (["preset=fast"], {"case": "paper"}, "did you mean ./run --config case=paper preset=fast?"),
        (["verfy"], {}, "'verfy' is no target; did you mean ./run verify?"),
        (["papr"], {}, "'papr' is no target; did you mean ./run --config case=paper?"),
        (["x=1"], {}, "'x=1' is no target; ./run --help lists them"),
        (["README.md"], {}, "'README.md' is no target; did you mean ./run readme?"),
        (
            ["results/paper/a"],
            {"case": "short"},
            "another run; did you mean ./run results/paper/a --config case=paper?",
        ),
        (
            ["results/paper-fast/a"],
            {},
            "did you mean ./run results/paper-fast/a --config case=paper preset=fast?",
        ),
        (["results/papr/a"], {}, "results/papr/a: there is no case 'papr'; did you mean paper?"),
        ([], {"stability": "reduced"}, "did you mean ./run stability --config stability=reduced?"),
        (
            ["verify"],
            {"study": "verify"},
            "of the target readme; did you mean ./run readme --config study=verify?",
        ),
        ([], {"peers": {"beds": ["a", "b"]}}, "did you mean ./run peers --config 'peers={beds: [a, b]}'?"),
    ],
)
def test_other_targets_are_refused_with_the_line_that_was_meant(targets, words, message):
    assert message in message_of(check_targets, targets, words, RULES, CASES, {"short"})


@pytest.mark.parametrize("targets", [["stability"], ["study_stability"], ["results/stability/stability.csv"]])
def test_a_word_of_a_study_passes_with_its_target(targets):
    check_targets(targets, {"stability": "reduced"}, [*RULES, "study_stability"], CASES, {"short"})


def test_targets_of_particles_are_refused_for_a_case_without_them():
    message = r"estimate needs particles, .* is a network; did you mean ./run estimate --config case=short"
    with pytest.raises(UserError, match=message):
        check_targets(["estimate"], {"case": "riser"}, ["all"], ["riser", "short"], {"riser"}, "a network")
    check_targets(["all"], {"case": "riser"}, ["all"], ["riser"], {"riser"}, "a network")
