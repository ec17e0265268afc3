# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of the set-up beside the Python packages: what it says, and that it ends with the set-up."""

import hashlib
import os
import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from made import ROOT

ENVS = ROOT / "envs"
# in place of openfoam_headers.sh: it says that it goes on, and then works for longer than any test
WORKING = "touch at_work; sleep 60"


@pytest.fixture
def set_up(tmp_path: Path) -> Iterator[Callable[[str], subprocess.Popen[str]]]:
    """Starts a set-up that lacks only OpenFOAM's headers, with a script in place of theirs."""
    shutil.copytree(ENVS, tmp_path / "envs")
    (tmp_path / "envs/debian_packages.sh").write_text("")
    version = subprocess.check_output(["/usr/bin/python3", "-V"], text=True).strip()
    lock = hashlib.sha256((ENVS / "requirements.txt").read_bytes()).hexdigest()[:16]
    (tmp_path / ".venv").mkdir()
    (tmp_path / ".venv/.stamp").write_text(f"{lock} {version} {tmp_path}\n")
    started = []

    def start(headers: str) -> subprocess.Popen[str]:
        (tmp_path / "envs/openfoam_headers.sh").write_text(headers)
        command = ["sh", str(tmp_path / "envs/setup.sh")]
        started.append(subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True))
        return started[-1]

    yield start
    for process in started:
        process.kill()


def wait_until(done: Callable[[], bool]) -> None:
    end = time.monotonic() + 30
    while not done():
        assert time.monotonic() < end
        time.sleep(0.02)


def processes_in(folder: Path) -> list[str]:
    """Command lines of the processes that work in a folder."""
    lines = []
    for process in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            if (process / "cwd").resolve() == folder.resolve():
                lines.append((process / "cmdline").read_text())
    return [line for line in lines if line]  # one that has ended has none


def test_what_goes_wrong_beside_the_python_packages_is_said_last(set_up, tmp_path: Path) -> None:
    process = set_up("echo setup: error: no source package >&2; exit 1")
    assert process.communicate(timeout=30)[1] == "setup: error: no source package\n"
    assert process.returncode == 1
    process = set_up("echo setup: .openfoam is ready >&2")
    assert (process.communicate(timeout=30)[1], process.returncode) == ("setup: .openfoam is ready\n", 0)


def test_nothing_goes_on_after_the_python_packages_failed(set_up, tmp_path: Path) -> None:
    (tmp_path / ".venv/.stamp").unlink()
    (tmp_path / ".venv/thesis.py").touch()  # an environment of the user's own, which is refused
    process = set_up(WORKING)
    message = process.communicate(timeout=30)[1]
    assert process.returncode == 1 and message.splitlines()[-1].startswith(
        "setup: error: the set-up needs the place of"
    )
    wait_until(lambda: not processes_in(tmp_path))


@pytest.mark.parametrize("end", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_all_of_the_set_up(set_up, tmp_path: Path, end: signal.Signals) -> None:
    process = set_up(WORKING)
    wait_until((tmp_path / "at_work").exists)
    os.killpg(process.pid, end)
    assert process.wait(timeout=30) == 128 + end
    wait_until(lambda: not processes_in(tmp_path))
