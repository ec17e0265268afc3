# SPDX-License-Identifier: GPL-3.0-or-later
"""The workflow through a real SLURM of one node: jobs that are cancelled or run out of time go on.

Without Debian's packages of SLURM it is skipped; nothing is installed and no SLURM of the machine is touched.
"""

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pytest

from made import ROOT, kills
from made.kills import END_S, Folder
from made.processes import wait_until
from made.slurm import PACKAGES, missing_programs, slurm
from made.workflow import built_solver

pytestmark = pytest.mark.skipif(
    bool(missing_programs()),
    reason=f"SLURM is not installed ({', '.join(missing_programs())}): apt-get install {PACKAGES}",
)

WHOLE_S = 4 * END_S  # of the run with its tries
ENDED_S = 120.0  # until a signal to the run has ended its jobs
GONE_S = 10.0  # and from then on, their processes
REPEATS, VARIANTS = (1, 2), ("base", "friction_0", "drag_beetstra")
# cells, chains and their comparison, a measured time, figures of them, and variants
TARGETS = [
    *("metrics.csv", "timing.csv", "figures/fig1_cells.png", "figures/fig2_cost.png"),
    *(f"tradeoff/{variant}/variant.json" for variant in VARIANTS),
]
# the second try of the run has less time than the run needs
LIMITS = ["--set-resources", "run_dem:runtime=1 if attempt == 2 else 60"]


@pytest.fixture(scope="module")
def cluster():
    """A SLURM, in a folder with a short name."""
    folder = Path(tempfile.mkdtemp(prefix="slurm_"))
    try:
        with slurm(folder / "s") as running:
            yield running
    finally:
        shutil.rmtree(folder)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A working folder with a small bed that has repeats, the solver and the profile."""
    monkeypatch.setitem(kills.CASE["comparison"], "repeats", len(REPEATS))
    bed = Folder.make(tmp_path / "folder", built_solver())
    (bed.path / "envs" / "profiles").symlink_to(ROOT / "envs" / "profiles")
    return bed


def submit(cluster, folder, targets, *options):
    """The run of a user: snakemake with the profile, its output in the folder's log."""
    snakemake = str(Path(sys.executable).with_name("snakemake"))
    command = [snakemake, "--profile", "envs/profiles/slurm", "--nolock", "--config", "case=small", *options]
    command += ["--", *(f"results/small/{target}" for target in targets)]
    with (folder.path / "log").open("ab") as log:
        return subprocess.Popen(
            command, cwd=folder.path, env=cluster.variables, stdout=log, stderr=log, stdin=subprocess.DEVNULL
        )


def jobs_of(cluster, rule):
    """Ids and states of the jobs of a rule, in their order."""
    return {job: state for job, (comment, state) in cluster.jobs().items() if comment == f"rule_{rule}"}


def segments(folder):
    """Finished segments and when each was written."""
    done = folder.results.glob("dem/*/segment_*[0-9]/particles.restart")
    return {file.parent.name: file.stat().st_mtime_ns for file in done}


def wait_for(run, happened):
    """Wait until something has happened in a run that has not ended."""
    wait_until(lambda: happened() or run.poll() is not None, WHOLE_S)
    assert run.poll() is None, "the run has ended"


def test_a_run_goes_on_after_scancel_and_a_time_limit(cluster, folder):
    before = set(cluster.jobs())
    run = submit(cluster, folder, TARGETS, *LIMITS)
    try:
        wait_for(run, lambda: len(segments(folder)) >= 1)
        kept = segments(folder)
        (first,) = jobs_of(cluster, "run_dem")
        cluster.ask("scancel", str(first))
        wait_for(run, lambda: len(jobs_of(cluster, "run_dem")) == 2)
        second = max(jobs_of(cluster, "run_dem"))
        # a node so slow that the limit comes first: its solver stands still in a segment
        wait_for(
            run,
            lambda: (
                (len(segments(folder)) > len(kept) and folder.victims("rank"))
                or jobs_of(cluster, "run_dem")[second] == "TIMEOUT"
            ),
        )
        for rank in folder.victims("rank"):
            os.kill(rank, signal.SIGSTOP)
        kept = segments(folder)
        assert run.wait(WHOLE_S) == 0, (folder.path / "log").read_text()
    finally:
        run.kill()
    assert list(jobs_of(cluster, "run_dem").values()) == ["CANCELLED", "TIMEOUT", "COMPLETED"]
    assert len(segments(folder)) > len(kept)
    assert {name: segments(folder)[name] for name in kept} == kept
    for target in TARGETS:
        assert (folder.results / target).stat().st_size > 0
    comments = [comment for job, (comment, _) in cluster.jobs().items() if job not in before]
    # a group's comment goes on with its rules
    comments = sorted(re.sub("^rule_(chains|figures)_.*", r"group_\1", comment) for comment in comments)
    print(*comments, sep="\n")
    assert [comment for comment in comments if "run_dem" not in comment] == sorted(
        [
            *("group_chains", "group_figures", "rule_time_models", "rule_write_parameters"),
            *(f"rule_repeat_dem_wildcards_{repeat}" for repeat in REPEATS),
            *(f"rule_run_variant_wildcards_{variant}" for variant in VARIANTS),
        ]
    )


def test_sigterm_ends_the_run_and_its_jobs_within_seconds(cluster, folder):
    run = submit(cluster, folder, ["dem.json"])
    wait_for(run, lambda: folder.victims("rank"))
    began = time.monotonic()
    run.send_signal(signal.SIGTERM)
    assert run.wait(ENDED_S) != 0
    wait_until(lambda: not cluster.jobs("pending", "running", "completing"), ENDED_S)
    wait_until(lambda: not folder.processes(), GONE_S)  # SLURM names a job ended before its last process is
    print(f"ended after {time.monotonic() - began:.0f} s")
