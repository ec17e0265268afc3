# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparison of all codes on the same bed, in turns, with each finished run on record."""

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
from bedchain.studies.peers.bed import PeerBed, fluidized_bed
from bedchain.studies.peers.peer import Outcome, Peer
from bedchain.studies.records import remembered
from bedchain.work_folders import discard_folder, work_folder

CASES = Path("cases")
STAT = Path("/proc/stat")
START_S = {"short": 1.0, "paper": 0.5}  # of gas before the comparison [s]: the bed bubbles or begins to
OTHER_START_S = 0.5


@dataclass(frozen=True)
class PeerRun:
    """A finished run, or the reason why there is none.

    Attributes
    ----------
    bed, code : str
    repeat : int
        From 1.
    outcome : Outcome or None
    others : float
        Processors used by other programs meanwhile [1]; where it is not small, times are unreliable.
    note : str
        Reason for a missing outcome.
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
    """Message on how to install a missing code; empty for an installed one."""
    if shutil.which(peer.program):
        return ""
    remedy = f"apt-get install --no-install-recommends {peer.package}" if peer.package else "run snakemake"
    return f"{peer.name} is not installed: {remedy}"


def duration_for(peer: Peer, bed: PeerBed, duration_s: float, longest_s: float) -> float:
    """Simulated time of a run [s], at most `duration_s` and what takes about `longest_s` of wall time."""
    cost = peer.cost_s * len(bed.particles) / bed.value("dem_step")
    return min(duration_s, longest_s / cost)


def record_file(folder: Path, bed: PeerBed, peer: Peer, duration_s: float, repeat: int) -> Path:
    """File of a run, named by all that the run depends on."""
    files = [file for item in peer.files for file in ([item] if item.is_file() else sorted(item.rglob("*")))]
    stamp = input_stamp([file for file in files if file.is_file()], f"{peer.ranks} ranks")
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


def program_time() -> float:
    """Processor time of this program and of its finished children [s]."""
    return sum(sum(resource.getrusage(who)[:2]) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def measure(peer: Peer, bed: PeerBed, folder: Path, duration_s: float) -> tuple[Outcome, float]:
    """Outcome of a run of a code, and the processors that other programs used meanwhile [1]."""
    machine, program, start = busy_time(STAT.read_text()), program_time(), time.monotonic()
    outcome = peer.run(bed, folder, duration_s)
    used = busy_time(STAT.read_text()) - machine - (program_time() - program)
    return outcome, max(used / (time.monotonic() - start), 0.0)


def run_once(peer: Peer, bed: PeerBed, folder: Path, duration_s: float, repeat: int) -> PeerRun:
    """A run from its record, or a new one; a code that fails leaves a note and no record."""
    record = record_file(folder, bed, peer, duration_s, repeat)
    work = work_folder(folder / bed.name / "work") / record.stem

    def run() -> dict[str, Any]:
        outcome, others = measure(peer, bed, work, duration_s)
        return asdict(PeerRun(bed.name, peer.name, repeat, outcome, others))

    try:
        result = remembered(record, run)
    except UserError as error:
        return PeerRun(bed.name, peer.name, repeat, None, note=f"failed: {error}")
    discard_folder(work)
    return PeerRun(**result | {"outcome": Outcome(**result["outcome"])})


def prepare(name: str, folder: Path, solver: Path, start_s: float | None) -> PeerBed:
    """The moving bed of a case after some time of gas [s]; None for the default of the case."""
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
) -> tuple[dict[str, PeerBed], list[PeerRun]]:
    """Runs of all codes on all beds, in turns: A B C, A B C.

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
        Approximate largest wall time of a run [s]; a slower code simulates less.
    start_s : float, optional
        Simulated time of gas before the comparison [s].
    say : callable
        Called with a line for each run.

    Returns
    -------
    beds : dict of str to PeerBed
        By name.
    runs : list of PeerRun

    Raises
    ------
    UserError
        A number is not above 0, there is no such case, no bedFoam, or another study is running in the folder.
    """
    for key, value in {"repeats": repeats, "duration": duration_s, "longest": longest_s}.items():
        if not value > 0:
            raise UserError(f"--{key} {value}: must be above 0")
    if not solver.exists():
        raise UserError(f"there is no solver {solver}: run snakemake build_solver")
    peer_beds, runs = {}, []
    with locked_folder(folder):
        for name in beds:
            say(f"{name}: the bed that all codes start from")
            bed = peer_beds[name] = prepare(name, folder, solver, start_s)
            runs += run_in_turns(bed, all_peers(solver), folder, repeats, duration_s, longest_s, say)
    return peer_beds, runs


def run_in_turns(
    bed: PeerBed,
    peers: list[Peer],
    folder: Path,
    repeats: int,
    duration_s: float,
    longest_s: float,
    say: Callable[[str], None],
) -> list[PeerRun]:
    """Runs of all codes on a bed, repeat after repeat; a code that is not installed gives a single note."""
    absent = {peer.name: note for peer in peers if (note := missing(peer))}
    runs = [PeerRun(bed.name, name, 1, None, note=note) for name, note in absent.items()]
    for note in absent.values():
        say(f"{bed.name}: {note}")
    for repeat in range(1, repeats + 1):
        for peer in (peer for peer in peers if peer.name not in absent):
            run = run_once(peer, bed, folder, duration_for(peer, bed, duration_s, longest_s), repeat)
            runs.append(run)
            done = run.outcome
            cost = f"{done.wall_s / done.simulated_s:.4g} s per simulated second" if done else run.note
            say(f"{bed.name}: {peer.name}, run {repeat} of {repeats}: {cost}")
    return runs
