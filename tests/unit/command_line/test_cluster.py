# SPDX-License-Identifier: GPL-3.0-or-later
"""No job is queued where no cluster takes it, or where its time limit ends it before its first segment."""

import pytest

from bedchain.case.load import load_case
from bedchain.command_line.cluster import PROGRAMS, check_slurm, check_time_limit
from made import ROOT
from made.refusals import message_of


@pytest.fixture
def programs(tmp_path, monkeypatch):
    """A folder of programs that are alone in the path."""
    monkeypatch.setenv("PATH", str(tmp_path))

    def write(name, script):
        (tmp_path / name).write_text(f"#!/bin/sh\n{script}\n")
        (tmp_path / name).chmod(0o755)

    return write


def test_a_machine_without_slurm_is_told_so(programs):
    programs("squeue", "exit 0")
    assert "there is no SLURM on this machine: no sbatch, scancel; start" in message_of(check_slurm)


def test_a_controller_that_does_not_answer_is_quoted(programs):
    for name in PROGRAMS:
        programs(name, "exit 0")
    programs("sinfo", "echo first >&2; echo 'Unable to contact slurm controller' >&2; exit 1")
    assert "SLURM does not answer (Unable to contact slurm controller): try" in message_of(check_slurm)
    programs("sinfo", "exit 1")
    assert "(it gives no reason)" in message_of(check_slurm)
    programs("sinfo", "exit 0")
    check_slurm()


@pytest.mark.parametrize("rule", ["run_dem", "repeat_dem"])
def test_a_time_limit_below_a_segment_is_refused_with_one_that_fits(rule):
    case = load_case(ROOT / "cases" / "paper" / "case.yaml")
    message = message_of(check_time_limit, case, rule, 1)
    assert f"a job of {rule} gets 1 min" in message
    check_time_limit(case, rule, int(message.rpartition("=")[2]))
