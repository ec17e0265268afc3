# SPDX-License-Identifier: GPL-3.0-or-later
"""Words of ./run and snakemake that nothing would read are refused before anything is planned."""

import os
import shutil
import subprocess

import pytest

from made import ROOT
from made.workflow import linked, snakemake

SETUP = "echo 'set up' >&2\n"
ACTIVATE = 'export PATH="$PWD/stub:$PATH"\nmkdir -p .setup\n'
SNAKEMAKE = '#!/bin/sh\nprintf "%s\\n" "$@"\n'


@pytest.fixture
def run(tmp_path):
    """``./run`` in a copy whose set-up installs nothing, and whose snakemake says its arguments."""
    shutil.copy(ROOT / "run", tmp_path)
    (tmp_path / "envs").mkdir()
    (tmp_path / "envs/setup.sh").write_text(SETUP)
    (tmp_path / "envs/activate.sh").write_text(ACTIVATE)
    shutil.copy(ROOT / "envs/one_run.sh", tmp_path / "envs")
    (tmp_path / "stub").mkdir()
    (tmp_path / "stub/snakemake").write_text(SNAKEMAKE)
    (tmp_path / "stub/snakemake").chmod(0o755)
    (tmp_path / ".setup").mkdir()
    for case in ("paper", "short"):
        (tmp_path / "cases" / case).mkdir(parents=True)
        (tmp_path / "cases" / case / "case.yaml").touch()
    return lambda *words: subprocess.run(
        ["./run", *words], cwd=tmp_path, capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize(
    ("words", "wrong", "meant"),
    [
        (
            ["--config", "case=paper", "results/paper/a"],
            "results/paper/a",
            "results/paper/a --config case=paper",
        ),
        (["--config", "case=paper", "verify", "-n"], "verify", "verify --config case=paper -n"),
        (["-C", "case=paper", "verify"], "verify", "verify -C case=paper"),
        (["-Ccase=paper", "preset=fast", "verify"], "verify", "verify -Ccase=paper preset=fast"),
        (["--config", "paper"], "paper", "--config case=paper"),
        (["--config", "paper", "preset=fast"], "paper", "--config case=paper preset=fast"),
        (
            ["--config", "tradeoff={dem: all}", "tradeoff"],
            "tradeoff",
            "tradeoff --config 'tradeoff={dem: all}'",
        ),
        (["--config", "verify"], "verify", None),
    ],
)
def test_a_target_after_config_is_refused_with_the_line_that_was_meant(run, words, wrong, meant):
    outcome = run(*words)
    assert outcome.returncode == 1 and outcome.stdout == "" and "set up" not in outcome.stderr
    assert f"run: error: '{wrong}' stands after --config" in outcome.stderr
    assert outcome.stderr.endswith(f"did you mean ./run {meant} ?\n" if meant else "key=value can be\n")


@pytest.mark.parametrize(
    "words",
    [
        [],
        ["verify", "--config", "case=paper", "preset=fast"],
        ["--config", "case=paper", "-n", "--cores", "4"],
        ["--config", "case=paper", "--", "verify", "results/a b"],
        ["--config", "tradeoff={dem: all}", "--forcerun", "plot_cells"],
    ],
)
def test_other_words_reach_snakemake_as_they_are(run, words):
    outcome = run(*words)
    assert outcome.returncode == 0 and outcome.stderr == "set up\n"
    arguments = outcome.stdout.splitlines()
    assert arguments[len(arguments) - len(words) :] == words


def test_no_word_of_test_and_setup_is_ignored():
    for command in (["sh", "test", "--fast", "unit"], ["sh", "envs/setup.sh", "checks", "all"]):
        outcome = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
        assert outcome.returncode == 1 and ("usage" in outcome.stdout or "one word" in outcome.stderr)


# one of each check of the Snakefile; tests/unit/command_line has the others, test_workflow.py that of cases
@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("--config fidelty=fast", "--config has no word 'fidelty'; did you mean ./run --config preset=fast?"),
        ("--config case=paper --config preset=fast", "--config is there 2 times"),
        ("paper", "'paper' is a case, no target; did you mean ./run --config case=paper?"),
        ("--cores 0", "--cores 0 runs nothing and waits for ever: take at least 1"),
    ],
)
def test_snakemake_itself_refuses_what_it_would_ignore(tmp_path, words, message):
    folder = linked(tmp_path)
    done = snakemake(folder, *words.split(), "--dry-run")
    (only,) = done.stderr.splitlines()
    assert done.returncode == 1 and only.startswith("error: ") and message in only
    assert done.stdout == "" and not (folder / "results").exists()


@pytest.fixture
def at_work(run, tmp_path):
    """A ./run of the short case that has begun and waits, in a folder with a solver."""
    (tmp_path / "results/bin").mkdir(parents=True)
    (tmp_path / "results/bin/bedFoam").touch(0o755)
    (tmp_path / "stub/snakemake").write_text('#!/bin/sh\necho begun\n[ -n "$AT_ONCE" ] || exec sleep 60\n')
    process = subprocess.Popen(["./run", "--config", "case=short"], cwd=tmp_path, stdout=subprocess.PIPE)
    assert process.stdout.readline() == b"begun\n"
    yield lambda *words: subprocess.run(
        ["./run", *words], cwd=tmp_path, capture_output=True, text=True, check=False,
        env=os.environ | {"AT_ONCE": "yes"},
    )  # fmt: skip
    process.kill()
    process.wait()


@pytest.mark.parametrize(
    "words",
    [
        ["--config", "case=short", "--dry-run"],
        ["-n"],
        ["estimate", "--config", "case=paper"],
        ["verify", "-Ccase=paper"],
    ],
)
def test_a_dry_run_and_another_case_go_beside_a_run(at_work, words):
    outcome = at_work(*words)
    assert outcome.returncode == 0 and outcome.stdout == "begun\n", outcome.stderr


@pytest.mark.parametrize(
    "words", [[], ["estimate", "--config", "case=short"], ["-Ccase=short", "preset=fast"]]
)
def test_the_same_case_is_refused_beside_its_run(at_work, words):
    outcome = at_work(*words)
    assert outcome.returncode == 1 and outcome.stdout == ""
    assert outcome.stderr.endswith(
        "run: another ./run of the case short is at work in this folder; wait for it or end it\n"
    )
