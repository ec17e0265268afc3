# SPDX-License-Identifier: GPL-3.0-or-later
"""LAMMPS with its GRANULAR package on the particles alone."""

import math
import re
from pathlib import Path

from bedchain.dem.processes import run_logged
from bedchain.errors import UserError
from bedchain.studies.peers.bed import PeerBed, write_inputs
from bedchain.studies.peers.liggghts import loop_time
from bedchain.studies.peers.peer import Outcome, Peer

DECK = Path("scripts/bedchain/studies/peers/inputs/in.lammps")
THERMO = re.compile(r"^Step Atoms KinEng c_height\s*\n((?:\s*\d.*\n)+)", re.MULTILINE)


def tangential_dashpot(poisson: float) -> float:
    """Dashpot of the tangential contact over that of the normal one, as LIGGGHTS has it [1].

    Both are the same share of the critical one there, so their ratio is the root of that of the stiffnesses,
    8 G* a and 2 E* a (Di Renzo and Di Maio 2005, Chem. Eng. Sci. 60, 1303).

    Parameters
    ----------
    poisson : float
        Poisson's ratio of both bodies [1].
    """
    effective_young = 1 / (2 * (1 - poisson**2))
    effective_shear = 1 / (4 * (1 + poisson) * (2 - poisson))
    return math.sqrt(8 * effective_shear / (2 * effective_young))


def last_height(log: Path) -> float:
    """Mean height of the particles at the end of the run [m].

    Raises
    ------
    UserError
        The log holds no such column.
    """
    tables = THERMO.findall(log.read_text(encoding="utf-8", errors="replace"))
    if not tables:
        raise UserError(f"{log} holds no table of Step, Atoms, KinEng and c_height")
    return float(tables[-1].strip().splitlines()[-1].split()[3])


def run(bed: PeerBed, folder: Path, duration_s: float) -> Outcome:
    """Run the deck of LAMMPS."""
    write_inputs(bed, folder, tangential_dashpot=tangential_dashpot(bed.value("poisson")))
    values = {
        "parameters": folder / "parameters.lig",
        "start": folder / "particles.data",
        "steps": bed.dem_steps(duration_s),
    }
    command = ["lmp", "-in", str(DECK), "-log", "none"]
    for name, value in values.items():
        command += ["-var", name, str(value)]
    run_logged(command, folder / "lammps.log")
    wall, done, particles = loop_time(folder / "lammps.log")
    return Outcome(done * bed.value("dem_step"), wall, particles, done, last_height(folder / "lammps.log"))


PEER = Peer(
    "LAMMPS GRANULAR",
    "lmp",
    "lammps",
    False,
    "no gas; dashpot by Tsuji's fit to the restitution",
    run,
    3e-7,
    (DECK,),
)
