# SPDX-License-Identifier: GPL-3.0-or-later
"""The bed that all codes run: the numbers of a case, and moving particles from the decks of this project."""

import hashlib
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from bedchain.array_files import map_npy
from bedchain.case.load import load_case
from bedchain.case.parameters import Parameter, liggghts_text, openfoam_text, solver_parameters
from bedchain.case.schema import load_schema
from bedchain.dem.gas_case import prepare_gas
from bedchain.dem.particle_files import write_particles
from bedchain.dem.processes import run_deck, run_logged
from bedchain.dem.segments import COLUMNS, RESTART, SETTLED, STAMP_DIGITS, input_stamp
from bedchain.errors import UserError
from bedchain.files import atomic_folder
from bedchain.trajectory.dumps import read_dump
from bedchain.work_folders import fresh_folder

DECKS = Path("liggghts_inputs")
OWN_DECKS = (DECKS / "include", DECKS / "verify")
MOVING = "moving"
START = "start.npy"


@dataclass(frozen=True)
class PeerBed:
    """A bed at the time from which every code runs it.

    Attributes
    ----------
    name : str
        In the table.
    parameters : list of Parameter
        Of the solvers.
    particles : (n, 5) ndarray
        x, z [m], vx, vz [m/s] and diameter [m]; without spin and history of contacts.
    """

    name: str
    parameters: list[Parameter]
    particles: np.ndarray

    @property
    def stamp(self) -> str:
        """Digest of the numbers and particles."""
        digest = hashlib.sha256(np.ascontiguousarray(self.particles).tobytes())
        digest.update(liggghts_text(self.parameters).encode())
        return digest.hexdigest()[:STAMP_DIGITS]

    @property
    def weight_per_area(self) -> float:
        """Weight of the particles over the cross section [Pa]: the pressure drop of the fluidized bed."""
        volume = np.pi / 6 * (self.particles[:, 4] ** 3).sum()
        area = self.value("width") * self.value("thickness")
        return float(self.value("density") * volume * self.value("gravity") / area)

    def value(self, name: str) -> float:
        """A number of the solvers by its name, in its unit."""
        return float(next(item.value for item in self.parameters if item.name == name))

    def gas_steps(self, duration_s: float) -> int:
        """Whole gas steps in a time, at least two."""
        return max(2, round(duration_s / self.value("gas_step")))

    def end_time(self, duration_s: float) -> float:
        """Time at the end of `gas_steps` of a time [s]."""
        return round(self.gas_steps(duration_s) * self.value("gas_step"), 9)

    def dem_steps(self, duration_s: float) -> int:
        """Steps of the particles in `gas_steps` of a time."""
        return self.gas_steps(duration_s) * int(self.value("coupling_steps"))


def with_numbers(parameters: list[Parameter], **numbers: float | str) -> list[Parameter]:
    """Parameters with some replaced by name, and new ones added."""
    left = dict(numbers)
    changed = [
        replace(item, value=left.pop(item.name), source="the comparison") if item.name in left else item
        for item in parameters
    ]
    return changed + [Parameter(name, value, "-", "the comparison") for name, value in left.items()]


def write_inputs(bed: PeerBed, folder: Path, **numbers: float | str) -> None:
    """Empty a folder and write parameters for both kinds of solver and the particles of a bed into it.

    Parameters
    ----------
    bed : PeerBed
    folder : Path
        Gets ``parameters.lig``, ``caseParameters`` and ``particles.data``.
    **numbers
        Parameters to replace or add.
    """
    fresh_folder(folder)
    parameters = write_parameters(bed, folder, frozen=0, **numbers)
    write_particles(folder / "particles.data", bed.particles, {item.name: item.value for item in parameters})


def fluidized_bed(case_file: Path, folder: Path, solver: Path, start_s: float) -> PeerBed:
    """The bed of a case in motion: settled without gas, then run by bedFoam up to a time, or from the folder.

    Parameters
    ----------
    case_file : Path
        ``case.yaml``.
    folder : Path
        Keeps the settled and the moving bed, under a stamp of the inputs.
    solver : Path
        bedFoam.
    start_s : float
        Simulated time from the start of the gas, with the ramp of the case [s].

    Returns
    -------
    PeerBed
        Positions and velocities at that time.

    Raises
    ------
    UserError
        The bed is more than one layer thick, or of parcels.
    """
    bed = PeerBed(
        case_file.parent.name, solver_parameters(load_case(case_file), load_schema()), np.empty((0, 5))
    )
    if bed.value("particles_per_parcel") != 1:
        raise UserError(f"{case_file}: particles.parcel_diameters: the other codes know no parcels; take 1")
    if bed.value("depth_walls"):
        raise UserError(f"{case_file}: bed.layers: the comparison runs beds of one layer; take another case")
    folder.mkdir(parents=True, exist_ok=True)
    parameters = folder / "parameters.lig"
    parameters.write_text(liggghts_text(bed.parameters), encoding="utf-8")
    includes = sorted((DECKS / "include").glob("*.in"))
    settled = folder / f"{SETTLED}_{input_stamp([parameters, DECKS / 'in.settle', *includes])}"
    moving = (
        folder / f"{MOVING}_{input_stamp([parameters, DECKS / 'in.fluidize', *includes], f'{start_s:g}')}"
    )
    if not settled.exists():
        with atomic_folder(settled) as part:
            _settle(bed, part)
    if not moving.exists():
        with atomic_folder(moving) as part:
            np.save(part / START, _moving_particles(bed, settled, part, solver, start_s))
    return replace(bed, particles=map_npy(moving / START).copy())


def write_parameters(bed: PeerBed, folder: Path, **numbers: float | str) -> list[Parameter]:
    """Write ``parameters.lig`` and ``caseParameters`` of a bed with some numbers replaced or added."""
    parameters = with_numbers(bed.parameters, **numbers)
    (folder / "parameters.lig").write_text(liggghts_text(parameters), encoding="utf-8")
    (folder / "caseParameters").write_text(openfoam_text(parameters), encoding="utf-8")
    return parameters


def solver_settings(
    bed: PeerBed,
    folder: Path,
    duration_s: float,
    deck: str,
    restart: Path,
    ranks: int = 1,
    row_every: int = 10,
) -> dict[str, object]:
    """Settings of a run of bedFoam from time 0, for `prepare_gas`.

    Parameters
    ----------
    bed : PeerBed
    folder : Path
        Of the parameters and the output.
    duration_s : float
        Simulated time [s].
    deck : str
        Below `DECKS`.
    restart : Path
        Particles at the start.
    ranks, row_every : int
        MPI ranks; gas steps to a row of bed_series.csv.
    """
    return {
        "ranks": ranks,
        "start_time": 0,
        "end_time": bed.end_time(duration_s),
        "start_step": 0,
        "row_every": row_every,
        "deck": str(DECKS / deck),
        "decks": str(DECKS),
        "parameters": str(folder / "parameters.lig"),
        "restart": str(restart),
        "output": str(folder),
    }


def _settle(bed: PeerBed, folder: Path) -> None:
    """Let the particles fall and come to rest."""
    write_parameters(bed, folder, frame_steps=int(bed.value("settle_steps")), dump_suffix="bin")
    variables = {"parameters": folder / "parameters.lig", "output": folder, "decks": DECKS}
    run_deck(DECKS / "in.settle", variables, folder / "liggghts.log")


def _moving_particles(bed: PeerBed, settled: Path, folder: Path, solver: Path, start_s: float) -> np.ndarray:
    """Run bedFoam; x, z, vx, vz and diameter of each particle at the end, (n, 5)."""
    steps = bed.dem_steps(start_s)
    write_parameters(bed, folder, frame_steps=steps, dump_suffix="bin")
    settings = solver_settings(bed, folder, start_s, "in.fluidize", settled / RESTART)
    prepare_gas(folder / "gas", folder / "caseParameters", settled, settings)
    run_logged([str(solver), "-case", str(folder / "gas")], folder / "bedFoam.log")
    values = read_dump(folder / f"frame_{steps}.bin", COLUMNS[0]).values
    moving = values[np.argsort(values[:, 0]), 1:]
    return np.column_stack([moving, np.full(len(moving), bed.value("diameter"))])
