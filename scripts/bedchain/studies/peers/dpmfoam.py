# SPDX-License-Identifier: GPL-3.0-or-later
"""DPMFoam of OpenFOAM: particles and gas, with its collision model and its rule for the collision step."""

import math
import re
import shutil
import time
from pathlib import Path

import numpy as np

from bedchain.dem.processes import run_logged
from bedchain.errors import UserError
from bedchain.studies.peers.bed import PeerBed, write_inputs
from bedchain.studies.peers.peer import Outcome, Peer

CASE = Path("scripts/bedchain/studies/peers/inputs/dpmfoam")
CLOUD = Path("lagrangian/kinematicCloud")
SUBCYCLES = re.compile(r"^ +(\d+) move-collide subCycles")
SLOW_M_S = 0.1  # least speed for the rule, which a bed at rest soon reaches
HERTZ_TIME = 5.429675  # of DPMFoam's collision time, R (density / (E* sqrt(U)))^0.4
HEADER = "FoamFile\n{{\n version 2.0;\n format ascii;\n class {kind};\n object {name};\n}}\n"
NO_RECORDS = ("PairAccessed", "PairOrigProcOfOther", "PairOrigIdOfOther", "PairData")
NO_WALL_RECORDS = ("WallAccessed", "WallPRel", "WallData")
VECTOR_RECORDS = {"PairData", "WallPRel", "WallData"}


def dashpot(restitution: float) -> float:
    """DPMFoam's ``alpha`` that damps as LIGGGHTS's Hertz model does [1].

    Both damp by c sqrt(m k) overlap^(1/4), k = 4/3 E* sqrt(R) (the form of Tsuji, Tanaka and Ishida 1992,
    Powder Technol. 71, 239); LIGGGHTS's c is sqrt(5) times the damping ratio of a linear spring.

    Parameters
    ----------
    restitution : float
        Of an impact along the normal, above 0 and at most 1 [1].
    """
    logarithm = math.log(restitution)
    return math.sqrt(5) * -logarithm / math.hypot(logarithm, math.pi)


def resolution(bed: PeerBed, fastest: float) -> float:
    """``collisionResolutionSteps`` with which DPMFoam takes the particle step of the bed [1].

    Parameters
    ----------
    bed : PeerBed
    fastest : float
        Speed of the fastest particle [m/s]; the rule doubles it.
    """
    young = bed.value("young") / (2 * (1 - bed.value("poisson") ** 2))
    stiffness = young * math.sqrt(2 * max(fastest, SLOW_M_S))
    longest = HERTZ_TIME * bed.value("diameter") / 4 * (bed.value("density") / stiffness) ** 0.4
    # Half a sub-step fewer, since the rule rounds up
    steps = bed.value("coupling_steps") - 0.5
    return longest * steps / bed.value("gas_step")


def write_field(folder: Path, name: str, kind: str, content: str) -> None:
    """One field of the cloud."""
    text = HEADER.format(kind=kind, name=name) + content + "\n"
    (folder / name).write_text(text, encoding="utf-8")


def write_cloud(bed: PeerBed, start: Path) -> None:
    """The particles as DPMFoam's cloud, without contact history.

    Parameters
    ----------
    bed : PeerBed
    start : Path
        Folder of the first time.
    """
    folder, count = start / CLOUD, len(bed.particles)
    folder.mkdir(parents=True)
    uniform = start / "uniform" / CLOUD
    uniform.mkdir(parents=True)
    counted = f"geometry positions;\nprocessor0 {{ particleCount {count}; }}"
    write_field(uniform, "cloudProperties", "dictionary", counted)
    x, z, vx, vz, diameter = bed.particles.T
    columns = np.minimum(x / bed.value("width") * bed.value("gas_cells_x"), bed.value("gas_cells_x") - 1)
    rows = (z / bed.value("height") * bed.value("gas_cells_z")).astype(int)
    cells = rows * int(bed.value("gas_cells_x")) + columns.astype(int)
    located = zip(x.tolist(), z.tolist(), cells.tolist(), strict=True)
    places = "".join(f"({a!r} 0 {b!r}) {cell}\n" for a, b, cell in located)
    write_field(folder, "positions", "Cloud<basicKinematicCollidingParcel>", f"{count}\n(\n{places})")
    speeds = "".join(f"({a!r} 0 {b!r})\n" for a, b in zip(vx.tolist(), vz.tolist(), strict=True))
    write_field(folder, "U", "vectorField", f"{count}\n(\n{speeds})")
    write_field(folder, "origId", "labelField", f"{count}(" + " ".join(map(str, range(count))) + ")")
    same = {"d": diameter[0], "dTarget": diameter[0], "rho": bed.value("density")}
    for name, value in (same | {"nParticle": 1, "age": 0, "tTurb": 0}).items():
        write_field(folder, name, "scalarField", f"{count}{{{value}}}")
    for name, value in {"active": 1, "typeId": 1, "origProcId": 0}.items():
        write_field(folder, name, "labelField", f"{count}{{{value}}}")
    for name in ("UTurb", "f", "angularMomentum", "torque"):
        write_field(folder, name, "vectorField", f"{count}{{(0 0 0)}}")
    for name in NO_RECORDS + NO_WALL_RECORDS:
        kind = "vector" if name in VECTOR_RECORDS else "label"
        empty = f"{count + 1}{{0}}\n0()"
        write_field(folder, f"collisionRecords{name}", f"{kind}FieldCompactField", empty)


class Report:
    """Wall times at the end of each gas step, and sub-steps of the particles, from the lines of DPMFoam."""

    def __init__(self) -> None:
        self.ends: list[float] = []
        self.subcycles: list[int] = []

    def __call__(self, line: str) -> None:
        """Take one line of the log."""
        if line.startswith("ExecutionTime"):
            self.ends.append(time.monotonic())
        elif match := SUBCYCLES.match(line):
            self.subcycles.append(int(match[1]))


def inlet_pressure(gas: Path) -> np.ndarray:
    """Mean pressure over density at the inlet after each gas step, (n_steps,) [m2/s2].

    Raises
    ------
    UserError
        DPMFoam left no such table.
    """
    tables = sorted(gas.glob("postProcessing/inletPressure/*/surfaceFieldValue.dat"))
    if not tables:
        raise UserError(f"{gas}/postProcessing holds no pressure at the inlet: DPMFoam ran no step")
    return np.asarray(np.loadtxt(tables[-1], ndmin=2)[:, 1])


def heights(gas: Path, end_s: float) -> np.ndarray:
    """Heights of the particles at the end, (n_particles,) [m]."""
    file = gas / f"{end_s:g}" / CLOUD / "positions"
    places = re.findall(r"^\(\S+ \S+ (\S+)\) \d+$", file.read_text(encoding="utf-8"), re.MULTILINE)
    return np.array(places, float)


def run(bed: PeerBed, folder: Path, duration_s: float) -> Outcome:
    """Run DPMFoam at full gas velocity; its first gas step, from gas at rest, is not timed."""
    count = bed.gas_steps(duration_s)
    end_s = bed.end_time(duration_s)
    fastest = float(np.hypot(bed.particles[:, 2], bed.particles[:, 3]).max())
    numbers = {
        "dashpot": dashpot(bed.value("restitution")),
        "resolution": resolution(bed, fastest),
        "kinematic_viscosity": bed.value("gas_viscosity") / bed.value("gas_density"),
        "gravity_z": -bed.value("gravity"),
        "end_time": end_s,
        "gas_steps": count,
    }
    write_inputs(bed, folder, **numbers)
    gas = folder / "gas"
    shutil.copytree(CASE, gas)
    (gas / "0.orig").rename(gas / "0")
    shutil.copy(folder / "caseParameters", gas)
    run_logged(["blockMesh", "-case", str(gas)], gas / "mesh.log")
    write_cloud(bed, gas / "0")
    report = Report()
    run_logged(["DPMFoam", "-case", str(gas)], folder / "DPMFoam.log", report)
    final = heights(gas, end_s)
    drop = bed.value("gas_density") * inlet_pressure(gas)[count // 2 :].mean()
    gas_weight = bed.value("gas_density") * bed.value("gravity") * bed.value("height")
    return Outcome(
        end_s - bed.value("gas_step"),
        report.ends[-1] - report.ends[0],
        len(final),
        sum(report.subcycles[1:]),
        float(final.mean()),
        float(drop - gas_weight),
    )


PEER = Peer(
    "DPMFoam",
    "DPMFoam",
    "openfoam",
    True,
    "voidage not smoothed; inlet pressure lacks half a cell of drag; a sliding contact forgets its spring",
    run,
    6e-6,
    (CASE,),
)
