# SPDX-License-Identifier: GPL-3.0-or-later
"""Run every code on the same bed, in turns, and keep each finished run: a study that was stopped goes on."""

import os
import re
import resource
import shutil
import time
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from bedchain.dem.segments import input_stamp
from bedchain.errors import UserError
from bedchain.files import locked_folder
from bedchain.studies.peers import bedfoam, dpmfoam, lammps, liggghts, yade
from bedchain.studies.peers.bed import Bed, fluidized_bed
from bedchain.studies.peers.peer import Outcome, Peer
from bedchain.studies.records import remembered

CASES = Path("cases")
STAT = Path("/proc/stat")
START_S = {"short": 1.0, "paper": 0.5}  # of gas before the comparison [s]: the bed bubbles, or is about to
OTHER_START_S = 0.5


@dataclass(frozen=True)
class Run:
    """One finished run, or why there is none.

    Attributes
    ----------
    bed, code : str
    repeat : int
        From 1.
    outcome : Outcome or None
    others : float
        Processors that other programs used meanwhile [1]: times say little where it is not small.
    note : str
        Why there is no outcome.
    """

    bed: str
    code: str
    repeat: int
    outcome: Outcome | None
    others: float = 0.0
    note: str = ""


def all_peers(solver: Path) -> list[Peer]:
    """The codes in the order of the table."""
    return [*bedfoam.peers(solver), dpmfoam.PEER, liggghts.PEER, lammps.PEER, yade.PEER]


def missing(peer: Peer) -> str:
    """How to install a code that is not there; empty where it is."""
    if shutil.which(peer.program):
        return ""
    remedy = f"apt-get install --no-install-recommends {peer.package}" if peer.package else "run snakemake"
    return f"{peer.name} is not installed: {remedy}"


def duration_for(peer: Peer, bed: Bed, duration_s: float, longest_s: float) -> float:
    """Simulated time of a run [s]: what is asked for, or what the code does in `longest_s` of wall time."""
    cost = peer.cost_s * len(bed.particles) / bed.value("dem_step")
    return min(duration_s, longest_s / cost)


def record_file(folder: Path, bed: Bed, peer: Peer, duration_s: float, repeat: int) -> Path:
    """Where a run is kept; its name changes with everything that the run depends on."""
    found = [file for item in peer.files for file in ([item] if item.is_file() else sorted(item.rglob("*")))]
    stamp = input_stamp([file for file in found if file.is_file()], peer.ranks)
    name = re.sub(r"\W+", "_", peer.name.lower())
    stem = f"{name}_{bed.gas_steps(duration_s)}_{bed.stamp}_{stamp}_{repeat}"
    return folder / bed.name / "runs" / f"{stem}.json"


def busy_time(stat: str) -> float:
    """Processor time that all programs together have used since the machine started [s].

    Parameters
    ----------
    stat : str
        Content of ``/proc/stat``.
    """
    user, nice, system, _idle, _waiting, *interrupts = map(int, stat.split("\n", 1)[0].split()[1:9])
    return (user + nice + system + sum(interrupts)) / os.sysconf("SC_CLK_TCK")


def own_time() -> float:
    """Processor time of this program and of those that it ran [s]."""
    return sum(sum(resource.getrusage(who)[:2]) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def measure(peer: Peer, bed: Bed, folder: Path, duration_s: float) -> tuple[Outcome, float]:
    """Run a code once; its outcome, and the processors that other programs used meanwhile [1]."""
    machine, own, start = busy_time(STAT.read_text()), own_time(), time.monotonic()
    outcome = peer.run(bed, folder, duration_s)
    used = busy_time(STAT.read_text()) - machine - (own_time() - own)
    return outcome, max(used / (time.monotonic() - start), 0.0)


def run_once(peer: Peer, bed: Bed, folder: Path, duration_s: float, repeat: int) -> Run:
    """A run from its record, or made and recorded; a code that fails leaves a note and no record."""
    record = record_file(folder, bed, peer, duration_s, repeat)
    work = folder / bed.name / "work" / record.stem

    def made() -> dict[str, Any]:
        outcome, others = measure(peer, bed, work, duration_s)
        return asdict(Run(bed.name, peer.name, repeat, outcome, others))

    try:
        found = remembered(record, made)
    except UserError as error:
        return Run(bed.name, peer.name, repeat, None, note=f"failed: {error}")
    shutil.rmtree(work, ignore_errors=True)
    return Run(**found | {"outcome": Outcome(**found["outcome"])})


def prepare(name: str, folder: Path, solver: Path, start_s: float | None) -> Bed:
    """The moving bed of a case after so much time of gas [s]; None: by the case."""
    file = CASES / name / "case.yaml"
    if not file.exists():
        raise UserError(f"there is no case {name}: {file} is missing; take a folder of cases/")
    when = START_S.get(name, OTHER_START_S) if start_s is None else start_s
    return fluidized_bed(file, folder / name, solver, when)


def compare(
    beds: Iterable[str],
    folder: Path,
    solver: Path,
    repeats: int,
    duration_s: float,
    longest_s: float,
    start_s: float | None = None,
    say: Callable[[str], None] = print,
) -> tuple[dict[str, Bed], list[Run]]:
    """Run all codes on all beds, in turns: A B C, A B C.

    Parameters
    ----------
    beds : iterable of str
        Names of cases.
    folder : Path
        Keeps the beds and every finished run.
    solver : Path
        bedFoam.
    repeats : int
        Runs of each code on each bed.
    duration_s : float
        Simulated time of a run [s].
    longest_s : float
        Wall time of a run [s], roughly: a slower code simulates less.
    start_s : float, optional
        Simulated time of gas before the comparison [s].
    say : callable
        Gets a line for each run.

    Returns
    -------
    beds : dict of str to Bed
        By name.
    runs : list of Run

    Raises
    ------
    UserError
        A number is not above 0, there is no such case, no bedFoam, or another study is at work in the folder.
    """
    for key, value in {"repeats": repeats, "duration": duration_s, "longest": longest_s}.items():
        if not value > 0:
            raise UserError(f"--{key} {value}: must be above 0")
    if not solver.exists():
        raise UserError(f"there is no solver {solver}: run snakemake build_solver")
    found, runs = {}, []
    with locked_folder(folder):
        for name in beds:
            say(f"{name}: the bed that all codes start from")
            bed = found[name] = prepare(name, folder, solver, start_s)
            runs += run_in_turns(bed, all_peers(solver), folder, repeats, duration_s, longest_s, say)
    return found, runs


def run_in_turns(
    bed: Bed,
    peers: list[Peer],
    folder: Path,
    repeats: int,
    duration_s: float,
    longest_s: float,
    say: Callable[[str], None],
) -> list[Run]:
    """All codes on one bed, repeat after repeat; one that is not installed gives a single note."""
    absent = {peer.name: note for peer in peers if (note := missing(peer))}
    runs = [Run(bed.name, name, 1, None, note=note) for name, note in absent.items()]
    for note in absent.values():
        say(f"{bed.name}: {note}")
    for repeat in range(1, repeats + 1):
        for peer in (peer for peer in peers if peer.name not in absent):
            run = run_once(peer, bed, folder, duration_for(peer, bed, duration_s, longest_s), repeat)
            runs.append(run)
            done = run.outcome
            told = f"{done.wall_s / done.simulated_s:.4g} s per simulated second" if done else run.note
            say(f"{bed.name}: {peer.name}, run {repeat} of {repeats}: {told}")
    return runs
