# SPDX-License-Identifier: GPL-3.0-or-later
"""A bed as two fluids by OpenFOAM's twoPhaseEulerFoam with kinetic theory, in segments.

A segment is a folder ``segment_<n>``: the OpenFOAM case with its last fields, ``flow.npz`` with its frames,
``series.csv``, and ``segment.json``, written last. A run that was ended goes on after its last segment.
"""

import json
import math
import re
import shutil
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from bedchain.array_files import read_arrays
from bedchain.case.schema import Case
from bedchain.case.two_fluid import DRAG
from bedchain.dem.gas_case import copy_last_state
from bedchain.dem.processes import run_logged
from bedchain.dem.two_fluid_balance import COLUMNS, OUTSIDE_PA, balance_table, read_balance
from bedchain.dem.two_fluid_fields import Flow, read_frame
from bedchain.dem.two_fluid_start import field_text, grid_of, largest_solids, start_solids
from bedchain.dem.two_fluid_watch import Progress, check_solids, drift_of, fastest_place, read_series
from bedchain.errors import UserError
from bedchain.files import atomic_folder, write_arrays, write_csv, write_text

TEMPLATES, MESH = Path("openfoam_case/two_fluid"), Path("openfoam_case/system/blockMeshDict")
WATCH_STEPS, SERIES_STEPS = 50, 5  # between looks at the mass, and at the pressure
ROUNDING = 1e-6  # of a frame: a period that ends with it would end before its last step in every fourth frame


def run_two_fluid(folder: Path, case: Case) -> None:
    """Run a case to its end, or go on with it.

    Parameters
    ----------
    folder : Path
        With ``caseParameters``; gets ``segment_<n>``.
    case : dict
        A checked case with ``gas.model: two_fluid``.

    Raises
    ------
    UserError
        The solids' mass drifts, they pass their packing limit, or the solver ends: with place and time.
    """
    last, length = case["time"]["end_s"], case["time"]["segment_s"]
    count = math.ceil(last / length - 1e-9)
    for index in range(1, count + 1):
        target = folder / f"segment_{index:04d}"
        if (target / "segment.json").exists():
            continue
        span = (length * (index - 1), min(length * index, last))
        before = folder / f"segment_{index - 1:04d}"
        with atomic_folder(target) as part:
            prepare(part, folder / "caseParameters", before if index > 1 else None, case, span)
            record = run_segment(part, case, span, lost_until(before))
            keep_frames(part, case, span, lost_until(before))
            write_text(part / "segment.json", json.dumps(record) + "\n")


def prepare(part: Path, parameters: Path, before: Path | None, case: Case, span: tuple[float, float]) -> None:
    """Write the OpenFOAM case of a segment from `before`, or from the start."""
    gas = part / "gas"
    if before is None:
        for name in ("constant", "system"):
            shutil.copytree(TEMPLATES / name, gas / name)
        shutil.copytree(TEMPLATES / "0.orig", gas / "0")
        shutil.copy(MESH, gas / "system")
        solids = start_solids(case)
        for name, values in (("startSolids", solids), ("startGas", 1 - solids)):
            write_text(gas / name, field_text(values))
    else:
        copy_last_state(before / "gas", gas)
        shutil.copytree(TEMPLATES / "system", gas / "system", dirs_exist_ok=True)
        for name in ("startSolids", "startGas"):
            shutil.copy(before / "gas" / name, gas)
    shutil.copy(parameters, gas / "caseParameters")
    settings = {
        "start_time": span[0], "end_time": span[1], "frame_interval": case["time"]["frame_interval_s"],
        "mean_period": case["time"]["frame_interval_s"] * (1 + ROUNDING),
        "watch_steps": WATCH_STEPS, "series_steps": SERIES_STEPS, "largest_solids": largest_solids(case),
        "two_fluid_drag": DRAG[case["gas"]["drag_law"]], "ranks": 1,
    }  # fmt: skip
    write_text(gas / "segmentParameters", "".join(f"{key} {value};\n" for key, value in settings.items()))
    if before is None:
        run_logged(["blockMesh", "-case", str(gas)], part / "log")


def lost_until(segment: Path) -> float:
    """Solids that left at the top until the end of a segment [kg]; 0 before the first one."""
    record = segment / "segment.json"
    return float(json.loads(record.read_text()).get("lost_kg", 0)) if record.exists() else 0.0


def run_segment(part: Path, case: Case, span: tuple[float, float], lost_kg: float) -> dict[str, Any]:
    """Run the solver over a segment; its start, end and processor time, and the solids lost until its end.

    Raises
    ------
    UserError
        As `run_two_fluid`.
    """
    gas, progress = part / "gas", Progress(case["time"]["end_s"], span[0])
    try:
        run_logged(["twoPhaseEulerFoam", "-case", str(gas)], part / "log", progress)
    except UserError as error:
        raise UserError(
            f"the two-fluid run became unstable at {progress.now_s:g} s{fastest_place(gas, case)}: take a "
            f"smaller time.gas_step_s or a larger gas.cell_size_m\n{error}"
        ) from None
    lost = lost_kg + check_solids(gas, case, span, lost_kg)
    spent = {"cpu_s": progress.cpu_s, "memory_mb": progress.memory_mb}
    return {"start_s": span[0], "end_s": span[1], **spent, "lost_kg": lost}


def keep_frames(part: Path, case: Case, span: tuple[float, float], lost_kg: float) -> None:
    """Gather the frames in ``flow.npz`` and the pressure in ``series.csv``; of the fields the last stay."""
    gas, grid, density = part / "gas", grid_of(case), case["particles"]["density_kg_m3"]
    times = [item for item in gas.iterdir() if re.fullmatch(r"[0-9.]+", item.name)]
    times.sort(key=lambda item: float(item.name))
    frames = [item for item in times if float(item.name) > span[0] + 1e-9]
    shape = grid.rows, grid.columns
    solids, right, up = zip(*(read_frame(item, *shape, density) for item in frames), strict=True)
    write_arrays(
        part / "flow.npz",
        {
            "times_s": np.array([float(item.name) for item in frames]),
            "solids": np.array(solids, np.float32),
            "right": np.array(right, np.float32),
            "up": np.array(up, np.float32),
        },
    )
    terms = [read_balance(item, shape, case, largest_solids(case)) for item in frames]
    write_csv(balance_table([float(item.name) for item in frames], terms), part / "balance.csv")
    pressure = read_series(gas, "pressure")
    mass, _ = drift_of(gas, case, lost_kg)
    table = pd.DataFrame(
        {
            "time_s": pressure["time_s"],
            "pressure_drop_Pa": pressure["value"] - OUTSIDE_PA,
            "solids_drift_1": np.interp(pressure["time_s"], mass["time_s"], mass["drift"]),
        }
    )
    write_csv(table, part / "series.csv")
    shutil.rmtree(gas / "postProcessing")
    for item in times[:-1]:
        shutil.rmtree(item)


class Run(NamedTuple):
    """A two-fluid run.

    Attributes
    ----------
    flow : Flow
    series : DataFrame
        time_s, pressure_drop_Pa, solids_drift_1.
    balance : DataFrame
        As of `two_fluid_balance.balance_table`; empty for a run that did not keep them.
    cpu_s_per_s : float
        Processor time for a simulated second [s].
    memory_mb : float
        Peak of the solver [MB]; NaN for a run that did not keep it.
    """

    flow: Flow
    series: pd.DataFrame
    balance: pd.DataFrame
    cpu_s_per_s: float
    memory_mb: float = math.nan


def read_run(folder: Path) -> Run:
    """All segments of a run.

    Raises
    ------
    UserError
        There is no finished segment.
    """
    parts = sorted(record.parent for record in folder.glob("segment_*/segment.json"))
    if not parts:
        raise UserError(f"{folder} holds no finished segment of a two-fluid run")
    arrays = [read_arrays(part / "flow.npz") for part in parts]
    flow = Flow(
        *(np.concatenate([np.asarray(item[name], float) for item in arrays]) for name in Flow._fields)
    )
    records = [json.loads((part / "segment.json").read_text()) for part in parts]
    cost = sum(item["cpu_s"] for item in records) / sum(item["end_s"] - item["start_s"] for item in records)
    series = pd.concat([pd.read_csv(part / "series.csv") for part in parts], ignore_index=True)
    kept = [pd.read_csv(part / "balance.csv") for part in parts if (part / "balance.csv").exists()]
    balance = pd.concat(kept, ignore_index=True) if kept else pd.DataFrame(columns=COLUMNS)
    memory_mb = max(item.get("memory_mb", math.nan) for item in records)
    return Run(flow, series, balance, cost, memory_mb)
