# SPDX-License-Identifier: GPL-3.0-or-later
"""Small cases that check the solvers: inputs from a case file, particles from a table, results as arrays."""

import shutil
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from bedchain.case.load import load_case
from bedchain.case.parameters import Parameter, liggghts_text, openfoam_text, solver_parameters
from bedchain.case.schema import load_schema
from bedchain.dem.particle_files import read_frames, write_particles
from bedchain.dem.processes import run_deck, run_logged
from bedchain.work_folders import fresh_folder

DECKS = Path("liggghts_inputs")
GAS_CASE = Path("openfoam_case")
TIGHT = 1e-13  # tolerance of the linear solvers for results to round-off
FRAMES = 4  # the fewest for the windows of a case, which the checks do not use
GAS_STEP_S = 5e-4  # around frozen spheres


@dataclass(frozen=True)
class Setup:
    """A small case.

    Attributes
    ----------
    folder : Path
        Folder of its files; emptied first.
    sections : dict
        Keys of a case file, by section, where they differ from the schema's defaults.
    particles : (n, 5) ndarray
        x, z [m], vx, vz [m/s] and diameter [m] of each sphere.
    numbers : dict
        Numbers that no case file has, by their names in solvers and decks.
    """

    folder: Path
    sections: dict[str, dict[str, Any]]
    particles: np.ndarray
    numbers: dict[str, Any] = field(default_factory=dict)


def case_of(setup: Setup) -> dict[str, Any]:
    """Content of the case file; sections that the checks do not use are filled in for the schema.

    Frozen spheres take one step for each of the gas: whatever their step is, they stay where they are.
    """
    sections = setup.sections
    frame = sections["time"]["frame_interval_s"]
    moments = {"figures": {"moments_s": [frame], "batch_height_m": sections["bed"]["height_m"] / 2}}
    windows = {
        "learning": {"start_s": 0.0, "end_s": 2 * frame},
        "comparison": {"start_s": 2 * frame, "end_s": FRAMES * frame},
        "chain": {"lag_s": frame},
        "cells": {"columns": 1, "rows": 1},
        "run": {"ranks": 1},
        "mixing": {"split_z_m": sections["bed"]["height_m"] / 2},
    }
    case: dict[str, Any] = {"title": setup.folder.name, "seed": 10007, **moments, **windows}
    time = {"settle_s": frame, "ramp_s": frame, "end_s": FRAMES * frame, "segment_s": frame}
    time |= sections["time"]
    if setup.numbers.get("frozen"):
        step = time.get("gas_step_s", GAS_STEP_S)
        time |= {"gas_step_s": step, "dem_step_s": step, "allow_unstable_step": True}
    particles = {"number": len(setup.particles)} | sections.get("particles", {})
    return case | sections | {"time": time, "particles": particles}


def write_inputs(setup: Setup) -> dict[str, Any]:
    """Write case file, parameters of both solvers and particles into the emptied folder.

    Returns
    -------
    dict
        The solvers' parameters by name.
    """
    fresh_folder(setup.folder)
    file = setup.folder / "case.yaml"
    file.write_text(yaml.safe_dump(case_of(setup), sort_keys=False), encoding="utf-8")
    numbers = {"frozen": 0, "roof": 0} | setup.numbers
    parameters = [
        replace(item, value=numbers.pop(item.name), source="the check") if item.name in numbers else item
        for item in solver_parameters(load_case(file), load_schema())
    ]
    parameters += [Parameter(name, value, "-", "the check") for name, value in numbers.items()]
    (setup.folder / "parameters.lig").write_text(liggghts_text(parameters), encoding="utf-8")
    (setup.folder / "caseParameters").write_text(openfoam_text(parameters), encoding="utf-8")
    values = {item.name: item.value for item in parameters}
    write_particles(setup.folder / "particles.data", setup.particles, values)
    return values


def run_particles(setup: Setup, duration_s: float) -> np.ndarray:
    """Run LIGGGHTS alone.

    Returns
    -------
    (n_frames, n_particles, 6) ndarray
        id, x, z, vx, vz, omegay in each frame, sorted by id; the first frame is the start.
    """
    parameters = write_inputs(setup)
    values = {
        "parameters": setup.folder / "parameters.lig",
        "start": setup.folder / "particles.data",
        "output": setup.folder,
        "steps": round(duration_s / parameters["dem_step"]),
    }
    run_deck(DECKS / "verify/in.contact", values, setup.folder / "liggghts.log")
    return read_frames(setup.folder)


def run_gas(
    setup: Setup,
    solver: Path,
    duration_s: float,
    velocity: str,
    row_every: int = 1,
    tight: bool = False,
    slip: bool = False,
) -> pd.DataFrame:
    """Run bedFoam.

    Parameters
    ----------
    setup : Setup
    solver : Path
        bedFoam.
    duration_s : float
        Simulated time [s].
    velocity : str
        Superficial velocity over time as an OpenFOAM function, such as ``table ((0 0) (1 0.5))``.
    row_every : int
        Gas steps from row to row of the result.
    tight : bool
        Solve the gas to round-off.
    slip : bool
        Let the gas slip along the side walls: the flow is one-dimensional.

    Returns
    -------
    DataFrame
        bedFoam's bed_series.csv.
    """
    parameters = write_inputs(setup)
    gas = setup.folder / "gas"
    for name in ("constant", "system"):
        shutil.copytree(GAS_CASE / name, gas / name)
    shutil.copytree(GAS_CASE / "0.orig", gas / "0")
    shutil.copy(setup.folder / "caseParameters", gas / "caseParameters")
    changes = {"constant/gasProperties": f"superficialVelocity {velocity};"}
    if tight:
        limits = f"{{ tolerance {TIGHT}; relTol 0; }}"
        changes["system/fvSolution"] = f'solvers {{ p {limits} pFinal {limits} "(U|UFinal)" {limits} }}'
    if slip:
        changes["0/U"] = "boundaryField { sides { type slip; } }"
    for name, text in changes.items():
        # OpenFOAM takes the last of several entries of a name
        with (gas / name).open("a", encoding="utf-8") as stream:
            stream.write(f"\n{text}\n")
    settings = {
        "ranks": 1,
        "start_time": 0,
        "end_time": round(duration_s, 9),
        "start_step": 0,
        "row_every": row_every,
        "deck": f'"{DECKS}/verify/in.exchange"',
        "decks": f'"{DECKS}"',
        "parameters": f'"{setup.folder}/parameters.lig"',
        "restart": f'"{setup.folder}/particles.data"',
        "output": f'"{setup.folder}"',
    }
    text = "".join(f"{name} {value};\n" for name, value in settings.items())
    (gas / "segmentParameters").write_text(text, encoding="utf-8")
    assert parameters["gas_cells_y"] == 1
    run_logged(["blockMesh", "-case", str(gas)], gas / "mesh.log")
    run_logged([str(solver), "-case", str(gas)], setup.folder / "bedFoam.log")
    return pd.read_csv(gas / "bed_series.csv")
