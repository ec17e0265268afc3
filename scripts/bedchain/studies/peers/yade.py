# SPDX-License-Identifier: GPL-3.0-or-later
"""Yade on the particles alone."""

import json
from pathlib import Path

import numpy as np

from bedchain.dem.processes import run_logged
from bedchain.studies.peers.bed import PeerBed, write_inputs
from bedchain.studies.peers.peer import Outcome, Peer

SCRIPT = Path("scripts/bedchain/studies/peers/inputs/yade_bed.py")
NUMBERS = ("young", "poisson", "restitution", "friction", "density", "width", "gravity", "dem_step")


def run(bed: PeerBed, folder: Path, duration_s: float) -> Outcome:
    """Run the script in the Python of Yade."""
    write_inputs(bed, folder)
    np.save(folder / "particles.npy", bed.particles)
    numbers = {name: bed.value(name) for name in NUMBERS} | {"steps": bed.dem_steps(duration_s)}
    (folder / "bed.json").write_text(json.dumps(numbers, indent=1), encoding="utf-8")
    run_logged(["yade", "-n", "-x", "-j1", str(SCRIPT), str(folder)], folder / "yade.log")
    result = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    simulated = result["steps"] * bed.value("dem_step")
    return Outcome(simulated, result["wall_s"], result["particles"], result["steps"], result["mean_height_m"])


PEER = Peer("Yade", "yade", "yade", False, "no gas; dashpots by Yade's own formula", run, 1.2e-6, (SCRIPT,))
