# SPDX-License-Identifier: GPL-3.0-or-later
"""Processes that end with their run, and a run that ends with all that it started."""

import os
import shlex
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from bedchain.lifetime import RUN, begin_run, child_ends_with_parent, descendants, end_with_run
from made import ROOT
from made.processes import wait_until

JOB = "import time; from bedchain.lifetime import end_with_run; end_with_run(); print('on', flush=True); {}"
WAIT = "time.sleep(600)"
DEAF = "import signal; signal.signal(signal.SIGTERM, signal.SIG_IGN); " + WAIT
RUNNER = """
import subprocess, sys
from bedchain.lifetime import begin_run, end_all_at_sigterm
begin_run(); end_all_at_sigterm()
shell = subprocess.Popen(["sh", "-c", f"'{sys.executable}' -c '{sys.argv[1]}' & echo $!; wait"])
shell.wait()
"""


def python(code, *words, run=None):
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "scripts")}
    environment.pop(RUN, None)
    environment |= {RUN: str(run)} if run else {}
    command = [sys.executable, "-c", code, *words]
    return subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=environment
    )


def test_a_job_ends_when_its_shell_is_killed():
    line = f"{shlex.join([sys.executable, '-c', JOB.format(WAIT)])}; true"
    shell = f"import subprocess; subprocess.run(['sh', '-c', {line!r}])"
    with python(shell, run=os.getpid()) as outer:
        assert outer.stdout.readline() == "on\n"
        [middle, inner] = map(Path, (f"/proc/{number}" for number in descendants(outer.pid)))
        os.kill(int(middle.name), signal.SIGKILL)
        wait_until(lambda: not inner.exists())


@pytest.mark.parametrize("command", [["true"], ["sleep", "30"]])
def test_a_job_whose_run_or_shell_has_ended_before_it_began_ends_at_once(command):
    run = subprocess.Popen(command)  # of the second it is no descendant: one between them has ended
    if command == ["true"]:
        run.wait()
    with python(JOB.format(WAIT), run=run.pid) as job:
        assert job.wait(20) == -signal.SIGTERM and job.stdout.read() == ""
    run.kill()
    run.wait()


@pytest.mark.parametrize("run", ["", "word", str(os.getpid())])
def test_without_a_run_nothing_is_watched(run, monkeypatch):
    monkeypatch.setenv(RUN, run)
    end_with_run()


def test_a_job_of_a_cluster_is_a_run_of_its_own(monkeypatch):
    monkeypatch.setenv(RUN, "1")  # no process of this machine's run; followed, it would end this one
    begin_run(submitted=True)
    assert os.environ[RUN] == str(os.getpid())


def test_a_run_gives_its_jobs_its_number(monkeypatch):
    monkeypatch.setenv(RUN, "")
    begin_run()
    assert os.environ[RUN] == str(os.getpid())


@pytest.mark.parametrize(
    ("number", "code"),
    [(signal.SIGTERM, WAIT), (signal.SIGTERM, DEAF), (signal.SIGHUP, WAIT), (signal.SIGKILL, DEAF)],
)
def test_signals_to_a_run_end_all_that_it_started(number, code):
    with python(RUNNER, JOB.format(code).replace("'", '"')) as run:
        words = {run.stdout.readline().strip(), run.stdout.readline().strip()}
        [job] = (Path("/proc", word) for word in words - {"on"})
        assert int(job.name) in descendants(run.pid)
        run.send_signal(number)
        wait_until(lambda: not job.exists())


def test_a_child_whose_parent_died_first_does_not_stay():
    bind = child_ends_with_parent()
    if (child := os.fork()) == 0:
        bind()  # its parent is the one that made it: it goes on
        os._exit(7)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
    if (child := os.fork()) == 0:
        if os.fork() == 0:
            bind()  # its parent is another
            os._exit(7)
        os._exit(os.waitstatus_to_exitcode(os.wait()[1]) == -signal.SIGKILL)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 1
