# SPDX-License-Identifier: GPL-3.0-or-later
"""The bed that all codes run: a case's numbers, and particles in motion that the project's own decks made."""

import hashlib
import shutil
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

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

DECKS = Path("liggghts_inputs")
OWN_DECKS = (DECKS / "include", DECKS / "verify")
MOVING = "moving"
START = "start.npy"


@dataclass(frozen=True)
class Bed:
    """A bed at the moment from which every code runs it.

    Attributes
    ----------
    name : str
        In the table.
    parameters : list of Parameter
        Of the solvers.
    particles : (n, 5) ndarray
        x, z [m], vx, vz [m/s] and diameter [m]; they do not spin and contacts have no history.
    """

    name: str
    parameters: list[Parameter]
    particles: np.ndarray

    @property
    def stamp(self) -> str:
        """Name for its numbers and particles: the same ones have the same."""
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

    def dem_steps(self, duration_s: float) -> int:
        """Steps of the particles in that many whole gas steps."""
        return self.gas_steps(duration_s) * int(self.value("coupling_steps"))


def with_numbers(parameters: list[Parameter], **numbers: float | str) -> list[Parameter]:
    """Parameters with some replaced by name, and those added that no case file gives."""
    left = dict(numbers)
    changed = [
        replace(item, value=left.pop(item.name), source="the comparison") if item.name in left else item
        for item in parameters
    ]
    return changed + [Parameter(name, value, "-", "the comparison") for name, value in left.items()]


def write_inputs(bed: Bed, folder: Path, **numbers: float | str) -> None:
    """Empty a folder and write the bed's parameters, for both kinds of solver, and its particles into it.

    Parameters
    ----------
    bed : Bed
    folder : Path
        Gets ``parameters.lig``, ``caseParameters`` and ``particles.data``.
    **numbers
        Replace parameters of these names, or add to them.
    """
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    parameters = with_numbers(bed.parameters, frozen=0, **numbers)
    (folder / "parameters.lig").write_text(liggghts_text(parameters), encoding="utf-8")
    (folder / "caseParameters").write_text(openfoam_text(parameters), encoding="utf-8")
    write_particles(folder / "particles.data", bed.particles, {item.name: item.value for item in parameters})


def fluidized_bed(case_file: Path, folder: Path, solver: Path, start_s: float) -> Bed:
    """The bed of a case in motion: settled without gas, then run by bedFoam up to a time; kept once made.

    Parameters
    ----------
    case_file : Path
        ``case.yaml``.
    folder : Path
        Keeps what was made, under a stamp of the inputs.
    solver : Path
        bedFoam.
    start_s : float
        Simulated time from the start of the gas, with the case's own ramp [s].

    Returns
    -------
    Bed
        Positions and velocities at that time.

    Raises
    ------
    UserError
        The bed is more than one layer thick.
    """
    bed = Bed(case_file.parent.name, solver_parameters(load_case(case_file), load_schema()), np.empty((0, 5)))
    if bed.value("depth_walls"):
        raise UserError(f"{case_file}: bed.layers: the comparison runs beds of one layer; take another case")
    folder.mkdir(parents=True, exist_ok=True)
    given = folder / "parameters.lig"
    given.write_text(liggghts_text(bed.parameters), encoding="utf-8")
    includes = sorted((DECKS / "include").glob("*.in"))
    settled = folder / f"{SETTLED}_{input_stamp([given, DECKS / 'in.settle', *includes], 1)}"
    moving = folder / f"{MOVING}_{input_stamp([given, DECKS / 'in.fluidize', *includes], 1, f'{start_s:g}')}"
    if not settled.exists():
        with atomic_folder(settled) as part:
            _settle(bed, part)
    if not moving.exists():
        with atomic_folder(moving) as part:
            np.save(part / START, _moving_particles(bed, settled, part, solver, start_s))
    return replace(bed, particles=np.load(moving / START))


def _write_parameters(bed: Bed, folder: Path, frame_steps: int) -> Path:
    """Parameters for both solvers, with binary frames after so many steps; the file for the decks."""
    parameters = with_numbers(bed.parameters, frame_steps=frame_steps, dump_suffix="bin")
    (folder / "caseParameters").write_text(openfoam_text(parameters), encoding="utf-8")
    (folder / "parameters.lig").write_text(liggghts_text(parameters), encoding="utf-8")
    return folder / "parameters.lig"


def _settle(bed: Bed, folder: Path) -> None:
    """Let the particles fall and come to rest."""
    parameters = _write_parameters(bed, folder, int(bed.value("settle_steps")))
    variables = {"parameters": parameters, "output": folder, "decks": DECKS}
    run_deck(DECKS / "in.settle", variables, folder / "liggghts.log")


def _moving_particles(bed: Bed, settled: Path, folder: Path, solver: Path, start_s: float) -> np.ndarray:
    """Run bedFoam; x, z, vx, vz and diameter of each particle at the end, (n, 5)."""
    steps = bed.dem_steps(start_s)
    parameters = _write_parameters(bed, folder, steps)
    settings: dict[str, object] = {
        "ranks": 1,
        "start_time": 0,
        "end_time": round(bed.gas_steps(start_s) * bed.value("gas_step"), 9),
        "start_step": 0,
        "row_every": 10,
        "deck": str(DECKS / "in.fluidize"),
        "decks": str(DECKS),
        "parameters": str(parameters),
        "restart": str(settled / RESTART),
        "output": str(folder),
    }
    prepare_gas(folder / "gas", folder / "caseParameters", settled, settings)
    run_logged([str(solver), "-case", str(folder / "gas")], folder / "bedFoam.log")
    values = read_dump(folder / f"frame_{steps}.bin", COLUMNS[0]).values
    moving = values[np.argsort(values[:, 0]), 1:]
    return np.column_stack([moving, np.full(len(moving), bed.value("diameter"))])
