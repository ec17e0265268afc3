# SPDX-License-Identifier: GPL-3.0-or-later
"""A small bed killed at random moments, and on a disk that is full for a moment: the same bytes at the end.

``BEDCHAIN_KILLS=50 pytest tests/long/test_kills.py -s`` kills so many times, and says what was killed where.
"""

import os
import shutil
import signal
import subprocess
import time

import numpy as np
import pytest

from made.kills import END_S, VICTIMS, Folder, kill_one
from made.workflow import built_solver

KILLS = int(os.environ.get("BEDCHAIN_KILLS", "5"))
SEED = int(os.environ.get("BEDCHAIN_SEED", "1"))
DISK_MB = 48


@pytest.fixture(scope="module")
def solver():
    """Path of bedFoam, built where that is needed."""
    return built_solver()


@pytest.fixture(scope="module")
def undisturbed(solver, tmp_path_factory):
    """What the bed leaves behind when nobody disturbs it."""
    folder = Folder.make(tmp_path_factory.mktemp("whole") / "folder", solver)
    assert folder.start().wait(END_S) == 0, (folder.path / "log").read_text()
    return folder.outcome()


def finish(folder, undisturbed):
    """Give the same command again until it ends well, and compare."""
    code = folder.start().wait(END_S)
    assert code == 0, (folder.path / "log").read_text()
    outcome = folder.outcome()
    assert outcome.keys() == undisturbed.keys()
    assert [name for name in outcome if outcome[name] != undisturbed[name]] == []


def test_a_bed_killed_at_random_moments_is_the_same(undisturbed, solver, tmp_path):
    folder, rng = Folder.make(tmp_path / "killed", solver), np.random.default_rng(SEED)
    killed, whole = 0, 0
    while killed < KILLS:
        said = kill_one(folder, list(VICTIMS)[killed % len(VICTIMS)], rng)
        if said is None:  # it has come to its end between the kills: from the start again
            finish(folder, undisturbed)
            shutil.rmtree(folder.results)
            whole += 1
            continue
        killed += 1
        print(f"kill {killed}: {said}", flush=True)
    finish(folder, undisturbed)
    print(f"{killed} kills, {whole + 1} whole runs, all the same bytes")


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT])
def test_a_signal_to_the_run_ends_it_within_seconds(undisturbed, solver, tmp_path, number):
    folder = Folder.make(tmp_path / "ended", solver)
    assert "snakemake" in kill_one(folder, "snakemake", np.random.default_rng(SEED), number)
    finish(folder, undisturbed)


@pytest.fixture
def small_disk(solver, tmp_path):
    """A working folder whose results are on a disk of their own."""
    folder = Folder.make(tmp_path / "disk", solver)
    results = folder.path / "results"
    (folder.path / "bin").mkdir()
    shutil.move(results / "bin" / "bedFoam", folder.path / "bin")
    options = ["-t", "tmpfs", "-o", f"size={DISK_MB}m", "bedchain", str(results)]
    if subprocess.run(["mount", *options], capture_output=True, check=False).returncode:
        pytest.skip("mount needs root")
    try:
        shutil.copytree(folder.path / "bin", results / "bin")
        yield folder
    finally:
        subprocess.run(["umount", "-l", str(results)], check=True)


def fill(file):
    """Fill a disk to its last byte with one file."""
    with file.open("wb", buffering=0) as stream:
        for size in (1 << 20, 1 << 12, 1):
            try:
                while stream.write(b"x" * size):
                    pass
            except OSError:
                continue


def test_a_bed_on_a_disk_that_is_full_for_a_moment_is_the_same(undisturbed, small_disk):
    rng, ballast = np.random.default_rng(SEED), small_disk.path / "results" / "ballast"
    noticed = 0
    for moment in range(max(KILLS // 2, 2)):
        run = small_disk.start()
        while not small_disk.victims("driver") and run.poll() is None:
            time.sleep(0.01)
        time.sleep(rng.uniform(0, 6))
        fill(ballast)
        time.sleep(rng.uniform(0.2, 4))
        ballast.unlink()
        code = run.wait(END_S)
        noticed += code != 0
        print(f"full {moment + 1}: the run ended with {code}", flush=True)
        if code == 0:
            finish(small_disk, undisturbed)
            shutil.rmtree(small_disk.results)
    finish(small_disk, undisturbed)
    assert "Traceback" not in (small_disk.path / "log").read_text()
    print(f"noticed {noticed} times")
