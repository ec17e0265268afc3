# SPDX-License-Identifier: GPL-3.0-or-later
"""A bed as two fluids by OpenFOAM's twoPhaseEulerFoam with kinetic theory, in segments.

A segment is a folder ``segment_<n>``: the OpenFOAM case with its last fields, ``flow.npz`` with its frames,
``series.csv``, and ``segment.json``, written last. A run that was ended goes on after its last segment.
"""

import json
import math
import re
import shutil
import sys
import time
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.array_files import read_arrays
from bedchain.case.schema import Case
from bedchain.case.two_fluid import DRAG
from bedchain.dem.gas_case import copy_last_state, last_time
from bedchain.dem.processes import clock_text, run_logged
from bedchain.dem.two_fluid_fields import Flow, read_frame
from bedchain.errors import UserError
from bedchain.files import atomic_folder, write_arrays, write_csv, write_text
from bedchain.physics.packing import PACKED_AREA_SHARE, slab_voidage

TEMPLATES, MESH = Path("openfoam_case/two_fluid"), Path("openfoam_case/system/blockMeshDict")
CLOSEST_AREA_SHARE = math.pi / (2 * math.sqrt(3))  # of the plane: closest discs
DRIFT_MAX = 1e-3  # of the solids' mass: the run stops
WATCH_STEPS, SERIES_STEPS = 50, 5  # between looks at the mass, and at the pressure
UNEVEN = ((0.05, 1, 0.7), (0.03, 5, 1.3))  # surface at the start: amplitude, half waves, phase
ROUNDING = 1e-6  # of a frame: a period that ends with it would end before its last step in every fourth frame
OUTSIDE_PA = 1e5  # pressure at the outlet, in the templates
TIME = re.compile(r"^Time = (\S+)")
EXECUTION = re.compile(r"ExecutionTime = (\S+) s")


class Grid(NamedTuple):
    """Cells of a two-fluid run: numbers along height and width, edge [m]."""

    nz: int
    nx: int
    cell_m: float


def grid_of(case: Case) -> Grid:
    """The gas cells of a case."""
    bed, cell = case["bed"], case["gas"]["cell_size_m"]
    return Grid(round(bed["height_m"] / cell), round(bed["width_m"] / cell), cell)


def largest_solids(case: Case) -> float:
    """Share of the solids that none exceeds [1]: closest discs in the slab, three digits."""
    thickness = case["bed"]["thickness_m"] / case["particles"]["diameter_m"]
    return round(1 - slab_voidage(CLOSEST_AREA_SHARE, thickness), 3)


def start_solids(case: Case) -> NDArray[np.float64]:
    """Share of the solids of each cell at the start, (nz, nx): a settled bed with an uneven surface [1]."""
    grid, bed, particles = grid_of(case), case["bed"], case["particles"]
    settled = 1 - slab_voidage(PACKED_AREA_SHARE, bed["thickness_m"] / particles["diameter_m"])
    volume = particles["number"] * math.pi / 6 * particles["diameter_m"] ** 3
    height = volume / (settled * bed["width_m"] * bed["thickness_m"])
    x = (np.arange(grid.nx) + 0.5) / grid.nx
    surface = np.ones(grid.nx)
    for size, waves, phase in UNEVEN:
        surface += size * np.sin(math.pi * waves * x + phase)
    surface = surface * height / surface.mean()
    low = grid.cell_m * np.arange(grid.nz)[:, None]
    return settled * np.clip((surface - low) / grid.cell_m, 0, 1)


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


def field_text(values: NDArray[np.float64]) -> str:
    """Values of cells as the entry ``internalField`` of OpenFOAM."""
    numbers = "\n".join(f"{value:.12g}" for value in values.ravel())
    return f"internalField nonuniform List<scalar> {values.size}\n(\n{numbers}\n);\n"


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
            f"the two-fluid run became unstable at {progress.now_s:g} s: take a smaller time.gas_step_s or a "
            f"larger gas.cell_size_m\n{error}"
        ) from None
    lost = lost_kg + check_solids(gas, case, span, lost_kg)
    return {"start_s": span[0], "end_s": span[1], "cpu_s": progress.cpu_s, "lost_kg": lost}


def drift_of(gas: Path, case: Case, lost_kg: float) -> tuple[pd.DataFrame, float]:
    """What solids in the bed and those that left sum to, over those at the start, less 1; and what left [kg].

    Parameters
    ----------
    gas : Path
        OpenFOAM case of a segment.
    case : dict
    lost_kg : float
        Solids that left before [kg].

    Returns
    -------
    DataFrame
        time_s, drift [1].
    float
        Solids that left in the segment [kg].
    """
    particles = case["particles"]
    whole = particles["density_kg_m3"] * particles["number"] * math.pi / 6 * particles["diameter_m"] ** 3
    mass, left = read_series(gas, "solids"), read_series(gas, "left")
    out = (left["value"] * case["time"]["gas_step_s"]).cumsum()
    until = np.interp(mass["time_s"], left["time_s"], out, left=0.0)
    inside = mass["value"] / start_solids(case).mean()
    drift = inside + (lost_kg + until) / whole - 1
    return pd.DataFrame({"time_s": mass["time_s"], "drift": drift}), float(out.iloc[-1])


def check_solids(gas: Path, case: Case, span: tuple[float, float], lost_kg: float = 0.0) -> float:
    """Refuse (`UserError`) a segment whose solids drifted or passed their packing limit: time and place.

    What leaves at the top is no drift; it is given back [kg].
    """
    mass, lost = drift_of(gas, case, lost_kg)
    drift = mass["drift"]
    if (far := drift.abs() > DRIFT_MAX).any():
        at = int(np.flatnonzero(far)[0])
        raise UserError(
            f"at {mass['time_s'].iloc[at]:g} s the solids' mass is {drift.iloc[at]:+.2%} off, more than "
            f"{DRIFT_MAX:.1%}: take a smaller time.gas_step_s"
        )
    limit, largest = largest_solids(case), read_series(gas, "largest")
    if (over := largest["value"] > limit).any():
        at = int(np.flatnonzero(over)[0])
        grid, last = grid_of(case), last_time(gas)
        assert last is not None
        solids = read_frame(last, grid.nz, grid.nx, 1.0)[0]
        row, column = np.unravel_index(int(solids.argmax()), solids.shape)
        raise UserError(
            f"at {largest['time_s'].iloc[at]:g} s a cell has {largest['value'].iloc[at]:.3f} of solids, over "
            f"the packing limit {limit:g} (densest at {span[1]:g} s: x {grid.cell_m * (column + 0.5):.3g} "
            f"m, z {grid.cell_m * (row + 0.5):.3g} m): take a smaller time.gas_step_s"
        )
    return lost


def read_series(gas: Path, name: str) -> pd.DataFrame:
    """Series of a function of the solver, (time_s, value)."""
    (file,) = (gas / "postProcessing" / name).glob("*/*.dat")
    return pd.read_csv(file, sep=r"\s+", comment="#", names=["time_s", "value"])


def keep_frames(part: Path, case: Case, span: tuple[float, float], lost_kg: float) -> None:
    """Gather the frames in ``flow.npz`` and the pressure in ``series.csv``; of the fields the last stay."""
    gas, grid, density = part / "gas", grid_of(case), case["particles"]["density_kg_m3"]
    times = [item for item in gas.iterdir() if re.fullmatch(r"[0-9.]+", item.name)]
    times.sort(key=lambda item: float(item.name))
    frames = [item for item in times if float(item.name) > span[0] + 1e-9]
    solids, right, up = zip(*(read_frame(item, grid.nz, grid.nx, density) for item in frames), strict=True)
    write_arrays(
        part / "flow.npz",
        {
            "times_s": np.array([float(item.name) for item in frames]),
            "solids": np.array(solids, np.float32),
            "right": np.array(right, np.float32),
            "up": np.array(up, np.float32),
        },
    )
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


def read_flow(folder: Path) -> tuple[Flow, pd.DataFrame, float]:
    """Frames, series and processor time for each simulated second of all segments of a run.

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
    return flow, pd.concat([pd.read_csv(part / "series.csv") for part in parts], ignore_index=True), cost


class Progress:
    """Progress of the solver on stderr every few seconds.

    Parameters
    ----------
    end_s : float
        Simulated time at the end of the whole run [s].
    start_s : float
        Simulated time at the start of the segment [s].
    """

    EVERY_S = 10.0

    def __init__(self, end_s: float, start_s: float) -> None:
        self.end_s, self.start_s, self.now_s, self.cpu_s = end_s, start_s, start_s, 0.0
        self.began = self.last = time.monotonic()

    def __call__(self, line: str) -> None:
        """Take one line of the solver's output."""
        if match := EXECUTION.search(line):
            self.cpu_s = float(match[1])
        if not (match := TIME.match(line)):
            return
        self.now_s = float(match[1])
        if (now := time.monotonic()) - self.last < self.EVERY_S:
            return
        self.last = now
        cost = (now - self.began) / max(self.now_s - self.start_s, 1e-9)
        print(
            f"two_fluid: {self.now_s:.3f} of {self.end_s:g} s simulated, {cost:.0f} s per simulated second, "
            f"{clock_text(cost * max(self.end_s - self.now_s, 0))} left",
            file=sys.stderr,
            flush=True,
        )
