# SPDX-License-Identifier: GPL-3.0-or-later
"""bedFoam on one rank and on two, with the decks and the gas of this project."""

import math
from functools import partial
from pathlib import Path

import pandas as pd

from bedchain.dem.gas_case import GAS_CASE, GAS_PARTS, prepare_gas
from bedchain.dem.processes import Progress, on_ranks, run_logged
from bedchain.studies.peers.bed import OWN_DECKS, PeerBed, solver_settings, write_inputs
from bedchain.studies.peers.peer import Outcome, Peer

NO_RAMP_S = 1e-9  # full velocity from the first gas step on


def run(bed: PeerBed, folder: Path, duration_s: float, solver: Path, ranks: int) -> Outcome:
    """Run bedFoam at the case's full gas velocity, on a number of ranks."""
    steps = bed.dem_steps(duration_s)
    write_inputs(bed, folder, frame_steps=steps, ramp_time=NO_RAMP_S)
    particles = folder / "particles.data"
    settings = solver_settings(bed, folder, duration_s, "verify/in.exchange", particles, ranks, row_every=1)
    gas = folder / "gas"
    prepare_gas(gas, folder / "caseParameters", folder / "nothing", settings)
    command = [str(solver), "-case", str(gas)] + (["-parallel"] if ranks > 1 else [])
    report = Progress(bed.end_time(duration_s), every_s=math.inf)  # for its totals, without lines
    run_logged(on_ranks(command, ranks), folder / "bedFoam.log", report)
    series = pd.read_csv(gas / "bed_series.csv")
    spent, last = report.totals, series.iloc[-1]
    return Outcome(
        spent["simulated"],
        spent["wall"],
        int(last["particles_1"]),
        steps,
        float(last["mean_height_m"]),
        float(series["pressure_drop_Pa"].iloc[len(series) // 2 :].mean()),
        spent["dem"],
        spent["exchange"],
        spent["gas"],
    )


def peers(solver: Path) -> list[Peer]:
    """bedFoam on one rank and on two."""
    files = (solver, *(GAS_CASE / part for part in GAS_PARTS), *OWN_DECKS)
    names = {1: "bedFoam", 2: "bedFoam, 2 ranks"}
    return [
        Peer(name, str(solver), "", True, "", partial(run, solver=solver, ranks=ranks), 2e-7, files, ranks)
        for ranks, name in names.items()
    ]
