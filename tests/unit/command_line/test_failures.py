# SPDX-License-Identifier: GPL-3.0-or-later
"""The last lines after a failure: stage, case, sentence, log, and how to go on."""

import os

import pytest

from bedchain.command_line.failures import LINES, cause, failure_report

LOG = """\
Building DAG of jobs...
[Wed Nov 25 21:40:20 2026]
Error in rule {rule}:
    message: None
    jobid: 3
    input: results/short/dem.json
    output: results/short/trajectory.npy
    log: {log} (check log file(s) for error details)
    shell:
        python x.py
Exiting because a job execution failed. Look below for error messages
"""
GO_ON = "To go on: mend the cause, then give the same command again; what is finished stays."


@pytest.fixture
def report(tmp_path, monkeypatch):
    """The report of failed rules with their logs, by the log of snakemake."""
    monkeypatch.chdir(tmp_path)

    def lines(*failures, since=0.0, more=""):
        for _, log, text in failures:
            if text is not None:
                (tmp_path / log).parent.mkdir(parents=True, exist_ok=True)
                (tmp_path / log).write_text(text)
        text = "".join(LOG.format(rule=rule, log=log) for rule, log, _ in failures) + more
        (tmp_path / "snakemake.log").write_text(text)
        return failure_report([tmp_path / "snakemake.log"], since).splitlines()

    return lines


def test_a_users_error_is_its_sentence(report):
    text = "12:00:00 read 3 frames\nerror: frame 3 is cut off; run segment 2 again\n"
    assert report(("parse_dumps", "logs/short/parse_dumps.log", text)) == [
        "",
        "Failed: parse_dumps of short",
        "  error: frame 3 is cut off; run segment 2 again",
        "  Its log: logs/short/parse_dumps.log",
        GO_ON,
    ]


def test_a_rule_of_the_papers_bed_and_one_of_a_study_are_named(report):
    lines = report(
        ("paper_run_chain", "logs/paper/run_chain_static.log", "error: a\n"),
        ("verify_solver", "logs/verify_solver.log", "error: b\n"),
        ("verify_solver", "logs/verify_solver.log", "error: b\n"),  # said twice by snakemake
    )
    assert [line for line in lines if line.startswith("Failed")] == [
        "Failed: run_chain of paper",
        "Failed: verify_solver",
    ]
    assert lines[-1] == GO_ON


def test_all_problems_of_a_file_are_shown_and_no_more_than_a_screen(report):
    assert cause("x\nerror: 2 problems:\n  a\n  b\n") == ["error: 2 problems:", "  a", "  b"]
    long = cause("error: many:\n" + "\n".join(map(str, range(100))))
    assert len(long) == LINES + 1 and long[-1] == "(more in the log)"


def test_an_error_that_was_got_over_is_not_the_cause():
    assert cause("error: first try\n12:00:01 tried again\nerror: second\n") == ["error: second"]


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("12:00 failed\nTraceback (most recent call last):\n  File x\nKeyError: 'n'\n", ["KeyError: 'n'"]),
        ("a\nb\n\nc\nd\n", ["b", "c", "d"]),
        ("", ["(its log is empty; what it said is above)"]),
        ("\r1 %\r2 %\nd\x1b[0m\n", ["1 %", "2 %", "d"]),
    ],
)
def test_without_a_sentence_the_last_lines_are_shown(text, lines):
    assert cause(text) == lines


def test_a_log_of_an_earlier_run_is_no_cause(report, tmp_path):
    failure = ("parse_dumps", "logs/short/parse_dumps.log", "error: long ago\n")
    report(failure)
    os.utime(tmp_path / failure[1], (1000, 1000))
    failed = ("parse_dumps", "logs/short/parse_dumps.log", None)
    lines = report(failed, since=2000.0)
    assert lines[2] == "  (it wrote no log; what it said is above)" and "log:" not in lines[3]
    assert report(("run_dem", "logs/short/run_dem.log", None))[2] == lines[2]


def test_a_stop_by_the_user_says_how_to_go_on(report):
    stopped = "Terminating processes on user request, this might take some time.\n"
    lines = report(("run_dem", "logs/short/run_dem.log", "0.3 s\n"), more=stopped)
    assert lines == [
        "",
        "Stopped: run_dem of short",
        "To go on: give the same command again; what is finished stays.",
    ]


def test_a_failure_of_no_job_leaves_snakemakes_own_words(report):
    assert report(more="WorkflowError:\n") == []


def test_bytes_that_are_no_text_do_no_harm(report, tmp_path):
    report(("run_dem", "logs/short/run_dem.log", ""))
    (tmp_path / "logs/short/run_dem.log").write_bytes(b"\xff\xfe\nerror: a \xff\n")
    assert "error: a" in "\n".join(failure_report([tmp_path / "snakemake.log"], 0.0).splitlines())
    assert failure_report([tmp_path / "missing.log"], 0.0) == ""
