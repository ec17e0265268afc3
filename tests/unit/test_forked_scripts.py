# SPDX-License-Identifier: GPL-3.0-or-later
"""Scripts are copies of one process; they fail, and end with a killed run, as any job does."""

import os
import shlex
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from bedchain.lifetime import RUN
from made import ROOT
from made.processes import wait_until

PATIENCE_S = 120.0
SNAKEFILE = """
import sys
sys.path.insert(0, {scripts!r})
from snakemake.script import PythonScript
from bedchain import forked_scripts
from bedchain.lifetime import begin_run
if workflow.is_main_process:
    del forked_scripts.LOADED[1:]
    begin_run()
    sys.executable = {python!r}
    forked_scripts.share_process(PythonScript)
    forked_scripts.share_process(PythonScript)
rule all:
    input: "a.txt", "b.txt"
rule a:
    output: "a.txt"
    script: "write.py"
rule b:
    output: "b.txt"
    threads: 2
    benchmark: "b.tsv"
    script: "write.py"
rule wrong:
    output: "wrong.txt"
    script: "wrong.py"
rule long:
    output: "long.txt"
    script: "long.py"
"""
WRITE = """
import os, sys, time
from pathlib import Path
loaded = [name for name in sys.modules if name.startswith("bedchain.")]
time.sleep(1.0)
threads = os.environ["OMP_NUM_THREADS"]
Path(snakemake.output[0]).write_text(f"{os.getppid()} {len(sys.argv)} {threads} {loaded}")
"""
LONG = """
import os, time
from pathlib import Path
from bedchain.lifetime import end_with_run
end_with_run()
Path("process.txt").write_text(str(os.getpid()))
time.sleep(600)
"""
LIBRARY = "['bedchain.forked_scripts']"


@pytest.fixture
def folder(tmp_path):
    scripts = {"write": WRITE, "long": LONG, "wrong": "raise ValueError('no such colour')"}
    for name, text in scripts.items():
        (tmp_path / f"{name}.py").write_text(text)
    (tmp_path / "my venv").symlink_to(sys.prefix)
    python = shlex.quote(str(tmp_path / "my venv/bin" / Path(sys.executable).name))
    (tmp_path / "Snakefile").write_text(SNAKEFILE.format(scripts=str(ROOT / "scripts"), python=python))
    return tmp_path


def start(folder, target):
    command = [sys.executable, "-m", "snakemake", "--cores", "2", target]
    environment = {name: value for name, value in os.environ.items() if name != RUN}
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    return subprocess.Popen(command, cwd=folder, env=environment, start_new_session=True, **pipes)


def test_scripts_share_a_process(folder):
    run = start(folder, "all")
    assert "Traceback" not in run.communicate(timeout=PATIENCE_S)[0] and run.returncode == 0
    a, b = ((folder / f"{name}.txt").read_text().split(maxsplit=1) for name in ("a", "b"))
    assert a == b and a[1] == f"1 1 {LIBRARY}"
    names, values = ((folder / "b.tsv").read_text().splitlines()[row].split("\t") for row in (0, 1))
    benchmark = dict(zip(names, values, strict=True))
    assert float(benchmark["s"]) >= 1.0 and float(benchmark["max_rss"]) > 1.0


def test_an_error_is_shown_and_fails_the_run(folder):
    run = start(folder, "wrong.txt")
    output = run.communicate(timeout=PATIENCE_S)[0]
    assert run.returncode == 1
    assert "ValueError: no such colour" in output and "Error in rule wrong" in output


def test_no_copy_outlives_a_killed_run(folder):
    run = start(folder, "long.txt")
    where = folder / "process.txt"
    wait_until(lambda: where.exists() and where.read_text(), PATIENCE_S)
    copy = Path(f"/proc/{where.read_text()}")
    assert copy.exists()
    os.kill(run.pid, signal.SIGKILL)
    run.communicate(timeout=PATIENCE_S)  # all that held its output have ended, the server too
    wait_until(lambda: not copy.exists())
