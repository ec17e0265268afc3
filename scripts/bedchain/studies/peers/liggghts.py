# SPDX-License-Identifier: GPL-3.0-or-later
"""LIGGGHTS on the particles alone, with the decks of this project: the upper limit for bedFoam."""

import re
from pathlib import Path

from bedchain.dem.particle_files import read_frames
from bedchain.dem.processes import run_deck
from bedchain.errors import UserError
from bedchain.studies.peers.bed import DECKS, OWN_DECKS, PeerBed, write_inputs
from bedchain.studies.peers.peer import Outcome, Peer

LOOP = re.compile(r"^Loop time of (\S+) on \d+ procs for (\d+) steps with (\d+) atoms", re.MULTILINE)


def loop_time(log: Path) -> tuple[float, int, int]:
    """Wall time [s], steps and particles of the last run in a log of LIGGGHTS or LAMMPS.

    Raises
    ------
    UserError
        The log holds no finished run.
    """
    loops = LOOP.findall(log.read_text(encoding="utf-8", errors="replace"))
    if not loops:
        raise UserError(f"{log} holds no finished run: its last lines say why")
    wall, steps, particles = loops[-1]
    return float(wall), int(steps), int(particles)


def run(bed: PeerBed, folder: Path, duration_s: float) -> Outcome:
    """Run ``in.contact``, which gives frames at the start and at the end."""
    steps = bed.dem_steps(duration_s)
    write_inputs(bed, folder, frame_steps=steps)
    values = {
        "parameters": folder / "parameters.lig",
        "start": folder / "particles.data",
        "output": folder,
        "decks": DECKS,
        "steps": steps,
    }
    run_deck(DECKS / "verify/in.contact", values, folder / "liggghts.log")
    wall, done, particles = loop_time(folder / "liggghts.log")
    height = float(read_frames(folder)[-1][:, 2].mean())
    return Outcome(done * bed.value("dem_step"), wall, particles, done, height)


PEER = Peer(
    "LIGGGHTS", "liggghts", "liggghts", False, "no gas: the limit for bedFoam", run, 1.5e-7, OWN_DECKS
)
