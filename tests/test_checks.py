# SPDX-License-Identifier: GPL-3.0-or-later
"""./test itself, over stand-ins of its commands: nothing fails unseen, and nothing outlives it."""

import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest

from made import ROOT

COMMANDS = (
    *("ruff", "mypy", "lint-imports", "snakefmt", "snakemake", "shellcheck", "clang-format"),
    "pytest",
)
CHECKS = 14
SECONDS = 60  # of a busy machine; on an idle one it takes two
STAND_IN = """#!/bin/sh
echo "this is $(basename "$0") $*"
case "$(basename "$0") $*" in {special}) {action} ;; esac
[ "$(basename "$0")" != pytest ] || echo "===== 3 passed in 0.1s ====="
"""


@pytest.fixture
def checks(tmp_path):
    """Function that gives the folder of a ./test of stand-ins, of which one does something else."""

    def make(special, action):
        shutil.copy(ROOT / "test", tmp_path)
        for folder in ("envs", "bin", "tests", "scripts", "openfoam_case"):
            (tmp_path / folder).mkdir()
        shutil.copy(ROOT / "envs/one_run.sh", tmp_path / "envs")
        (tmp_path / "envs/setup.sh").write_text("mkdir -p .setup\n")
        (tmp_path / "envs/activate.sh").write_text(f"PATH={tmp_path / 'bin'}:$PATH\n")
        for command in COMMANDS:
            stand_in = tmp_path / "bin" / command
            stand_in.write_text(STAND_IN.format(special=special, action=action))
            stand_in.chmod(0o755)
        return tmp_path

    return make


def table_of(output):
    """Outcome of each check, by the summary."""
    lines = output.split("== summary: ")[-1].splitlines()
    return {words[0]: words[1] for line in lines if len(words := line.split()) == 4 and words[3] == "s"}


def test_all_checks_pass_and_each_is_shown(checks):
    folder = checks("never", ":")
    outcome = subprocess.run(["sh", "test"], cwd=folder, capture_output=True, text=True, timeout=SECONDS)
    table = table_of(outcome.stdout)
    assert outcome.returncode == 0 and {*table.values()} == {"ok"}
    assert len(table) == CHECKS and {"set_up", "build", "solver", "unit", "end_to_end", "results"} < {*table}
    assert outcome.stdout.count("this is pytest") == 3
    assert "9 passed, 0 failed" in outcome.stdout


@pytest.mark.parametrize(
    ("special", "check"),
    [
        ("mypy*", "mypy"),
        ("pytest\\ tests/solver", "solver"),
        ("snakemake\\ *--rerun-incomplete", "end_to_end"),
    ],
)
def test_one_that_fails_is_seen_and_the_others_run(checks, special, check):
    folder = checks(special, "exit 1")
    outcome = subprocess.run(["sh", "test"], cwd=folder, capture_output=True, text=True, timeout=SECONDS)
    table = table_of(outcome.stdout)
    assert outcome.returncode == 1 and len(table) == CHECKS
    assert [name for name in table if table[name] == "FAILED"] == [check]
    assert "1 checks failed" in outcome.stdout


def processes_in(folder):
    """Commands of the processes at work in a folder."""
    places = [entry for entry in Path("/proc").iterdir() if entry.name.isdigit()]
    commands = []
    for place in places:
        try:
            if (place / "cwd").resolve() == folder:
                commands.append((place / "cmdline").read_text().replace("\0", " "))
        except OSError:
            continue  # it has ended
    return commands


@pytest.mark.parametrize("sent", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
def test_nothing_outlives_it(checks, sent):
    folder = checks("pytest*", "echo $$ >>pids; sleep 600")
    process = subprocess.Popen(["sh", "test"], cwd=folder, stdout=subprocess.DEVNULL, start_new_session=True)
    deadline = time.monotonic() + SECONDS
    # the tests of the solvers and, beside them, those without
    while not (folder / "pids").exists() or len((folder / "pids").read_text().split()) < 2:
        assert time.monotonic() < deadline
        time.sleep(0.05)
    process.send_signal(sent)
    assert process.wait(SECONDS) == 128 + sent
    while left := processes_in(folder):
        assert time.monotonic() < deadline, left
        time.sleep(0.05)
