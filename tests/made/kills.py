# SPDX-License-Identifier: GPL-3.0-or-later
"""A small bed simulated by snakemake in a folder of its own, its processes killed, its disk filled."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml

from bedchain.lifetime import RUN
from made.processes import wait_until
from made.workflow import linked

CASE = {
    "title": "small bed to be killed",
    "seed": 10007,
    "bed": {"width_m": 0.02, "height_m": 0.06},
    "particles": {"number": 300},
    "run": {"ranks": 2},
    "time": {
        "settle_s": 0.3, "ramp_s": 0.02, "end_s": 0.1, "frame_interval_s": 0.004, "segment_s": 0.02,
    },
    "learning": {"start_s": 0.02, "end_s": 0.06},
    "comparison": {"start_s": 0.06, "end_s": 0.1},
    "chain": {"lag_s": 0.004},
    "cells": {"columns": 2, "rows": 6},
    "mixing": {"split_z_m": 0.01},
    "figures": {"batch_height_m": 0.01, "moments_s": [0.004, 0.008, 0.012, 0.016]},
}  # fmt: skip
SOLVER = "results/bin/bedFoam"
# a process of the run by a word of its command line
VICTIMS = {
    "snakemake": r"^\S*python\S* \S*snakemake ",
    "shell": r"^\S*bash -c .*run_dem",
    "driver": r"^\S*python\S* scripts/run_dem.py",
    "mpirun": r"^mpirun ",
    "rank": r"^(results/bin/bedFoam|liggghts) ",
}
ORPHANS_S = 10.0  # until every solver has ended
START_S = 300.0  # until a process is there, on a machine that is busy
END_S = 900.0  # of a whole run


@dataclass
class Folder:
    """A working folder of the workflow, with the small bed as its case ``small``.

    Attributes
    ----------
    path : Path
        On whatever disk.
    """

    path: Path

    @classmethod
    def make(cls, path: Path, solver: Path) -> "Folder":
        """Links to the repository, a copy of the solver, and the case."""
        linked(path)
        (path / SOLVER).parent.mkdir(parents=True)
        shutil.copy2(solver, path / SOLVER)
        os.utime(path / SOLVER)
        case = path / "cases" / "small"
        case.mkdir()
        (case / "case.yaml").write_text(yaml.safe_dump(CASE), encoding="utf-8")
        return cls(path)

    @property
    def results(self) -> Path:
        """Folder of the case's results."""
        return self.path / "results" / "small"

    def start(self) -> subprocess.Popen[bytes]:
        """Snakemake, as ./run starts it, up to the end of the simulation."""
        command = [sys.executable, "-m", "snakemake", "--cores", "2", "--nolock", "--rerun-incomplete"]
        command += ["results/small/dem.json", "--config", "case=small"]
        command[1:3] = [str(Path(sys.executable).with_name("snakemake"))]
        environment = {name: value for name, value in os.environ.items() if name != RUN}
        with (self.path / "log").open("ab") as log:
            return subprocess.Popen(
                command, cwd=self.path, env=environment, stdout=log, stderr=log, stdin=subprocess.DEVNULL
            )

    def processes(self) -> dict[int, str]:
        """Command lines of all processes that work in the folder, by their ids."""
        lines = {}
        for entry in Path("/proc").iterdir():
            if entry.name.isdecimal():
                try:
                    if (entry / "cwd").resolve() == self.path and "Z" not in _state(entry):
                        text = (entry / "cmdline").read_bytes().replace(b"\0", b" ")
                        lines[int(entry.name)] = text.decode(errors="replace")
                except OSError:  # it has just ended
                    continue
        return lines

    def victims(self, kind: str) -> list[int]:
        """Ids of the processes of a kind."""
        return [number for number, line in self.processes().items() if re.search(VICTIMS[kind], line)]

    def parts(self, pattern: str = "*") -> list[str]:
        """Names of the folders of segments that are not complete."""
        return sorted(part.stem for part in self.results.glob(f"dem/*/{pattern}.part"))

    def seconds_to_end(self, kinds: tuple[str, ...] = tuple(VICTIMS)) -> float:
        """Wait until no process of some kinds is left; returns how long that took [s].

        Raises
        ------
        AssertionError
            One is left after `ORPHANS_S`.
        """
        began = time.monotonic()
        while left := [number for kind in kinds for number in self.victims(kind)]:
            assert time.monotonic() - began < ORPHANS_S, f"left: {left} of {self.processes()}"
            time.sleep(0.05)
        return time.monotonic() - began

    def outcome(self) -> dict[str, bytes]:
        """What the run left: manifest, series, and each file of its segments but the logs."""
        files = [self.results / "dem.json", self.results / "bed_series.csv"]
        files += [file for file in self.results.glob("dem/*/s*/**/*") if file.is_file()]
        contents = {
            str(file.relative_to(self.results)): file.read_bytes() for file in files if file.suffix != ".log"
        }
        return {name: _without_times(content) for name, content in contents.items()}


def _state(process: Path) -> str:
    return (process / "stat").read_text(errors="replace").rpartition(")")[2].split()[0]


def _without_times(content: bytes) -> bytes:
    """A record or manifest without the times that its segments took; other files as they are."""
    return re.sub(rb'"(wall|cpu|dem|exchange|gas)_s": [0-9.e+-]+', b"", content)


def kill_one(folder: Folder, kind: str, rng: np.random.Generator, number: int = signal.SIGKILL) -> str | None:
    """Start a run, kill one of its processes at a random moment, and wait until all others have ended.

    Three of four moments are in a segment: half of these in its first 0.3 s, when the solver reads a restart
    or writes one already, in so small a bed. The others are at the start, as a rule in the settling.

    Returns
    -------
    str or None
        What was killed, in which folders that were not complete, and how long the solvers took to end; None
        where the run had ended before.

    Raises
    ------
    AssertionError
        A solver is left after `ORPHANS_S`, or any process so long after the run has ended.
    """
    run = folder.start()
    if rng.random() < 1 / 4:
        _wait_for(folder, kind, run)
    else:
        _wait_for_segment(folder, run)
    time.sleep(float(rng.choice([rng.uniform(0, 0.3), rng.uniform(0, 3)])))
    victims = folder.victims(kind) or _wait_for(folder, kind, run)
    if not victims:
        run.wait()
        return None
    place = " ".join(folder.parts())
    os.kill(int(rng.choice(victims)), number)
    took_s = folder.seconds_to_end(("mpirun", "rank"))
    run.wait(END_S)  # a driver that still imports its library ends after that
    folder.seconds_to_end()
    return f"{kind} in {place or 'between'}, solvers gone after {took_s:.2f} s"


def _wait_for(folder: Folder, kind: str, run: subprocess.Popen[bytes]) -> list[int]:
    """Ids of the processes of a kind as soon as there are some; none where the run ends before."""
    wait_until(lambda: bool(folder.victims(kind)) or run.poll() is not None, START_S)
    return folder.victims(kind)


def _wait_for_segment(folder: Folder, run: subprocess.Popen[bytes]) -> None:
    """Wait until a solver runs in a segment, or the run ends."""
    wait_until(
        lambda: bool(folder.victims("rank") and folder.parts("segment_*")) or run.poll() is not None, START_S
    )
