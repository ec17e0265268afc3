# SPDX-License-Identifier: GPL-3.0-or-later
"""Pressure drop of gas through spheres held in place: a uniform lattice and a settled random bed."""

from pathlib import Path

import numpy as np
import pandas as pd

from bedchain.verification.bench import Setup, run_gas, run_particles, suspension
from bedchain.verification.laws import LAWS, ergun_gradient, pressure_gradient
from bedchain.verification.packing import at_rest, lattice, loose, rows_of_voidage
from bedchain.verification.plots import Curve, draw
from bedchain.verification.rows import Row

NEAR_LATTICE = 0.01
NEAR_RANDOM = 0.05
ERGUN = "Ergun 1952, Chem. Eng. Prog. 48, 89, eq. (11)"
VELOCITIES = np.geomspace(0.2, 2.0, 6)  # [m/s], a decade
HOLD = 0.02  # [s] at each velocity, a hundred relaxation times of the gas
RISE = 0.002  # [s] from one velocity to the next
DIAMETER = 1e-3
LATTICE_WIDTH, LATTICE_HEIGHT = 0.02, 0.1  # [m]
BED_WIDTH, BED_HEIGHT, BED_NUMBER = 0.04, 0.12, 1600  # [m], [m], [1]: settles about 4 cm deep
SETTLE = 0.4  # [s], the fall takes 0.15
ROW = 2.5e-3  # [m], rows in which the random bed's voidage is measured
TIME = {"frame_interval_s": 0.02}


def steps_of_velocity() -> str:
    """The velocities one after the other, each held, as an OpenFOAM table."""
    points = [f"({(k + held) * HOLD + (1 - held) * RISE:g} {u:g})"
              for k, u in enumerate(VELOCITIES) for held in (0, 1)]  # fmt: skip
    return f"table ((0 0) {' '.join(points)})"


def held_pressure(table: pd.DataFrame) -> np.ndarray:
    """Pressure drop at the end of each hold [Pa]."""
    ends = (np.arange(len(VELOCITIES)) + 1) * HOLD
    return np.interp(ends, table["time_s"], table["pressure_drop_Pa"])


def lattice_setup(folder: Path, law: str) -> Setup:
    """Touching spheres on a square lattice that fills the whole domain."""
    sections = {
        "bed": {"width_m": LATTICE_WIDTH, "height_m": LATTICE_HEIGHT},
        "particles": {"number": 1},
        "gas": {"drag_law": law},
        "time": TIME,
    }
    spheres = lattice(LATTICE_WIDTH, LATTICE_HEIGHT, DIAMETER, DIAMETER)
    return Setup(folder, sections, spheres, {"frozen": 1, "number": len(spheres)})


def check_lattice(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Rows and figure of the lattice: Ergun over a decade of velocity, and each law's own pressure drop."""
    rows, curves = [], []
    voidage = 1 - np.pi / 6
    for name, law in LAWS.items():
        setup = lattice_setup(work / f"lattice_{name}", name)
        found = held_pressure(run_gas(setup, solver, len(VELOCITIES) * HOLD, steps_of_velocity()))
        of = suspension(setup)
        theory = np.array([pressure_gradient(law, of, voidage, u) for u in VELOCITIES])
        if name == "gidaspow":
            theory, source = np.array([ergun_gradient(of, voidage, u) for u in VELOCITIES]), ERGUN
        else:
            source = f"{name} drag law, dp/dz = beta u / e (model A)"
        gradient = found / LATTICE_HEIGHT
        for velocity, value, reference in zip(VELOCITIES, gradient, theory, strict=True):
            if name == "gidaspow" or velocity == VELOCITIES[-1]:
                quantity = f"lattice at {velocity:.3g} m/s, {name}: pressure drop over height [Pa/m]"
                rows.append(Row(quantity, value, reference, NEAR_LATTICE, source))
        curves.append(Curve(name, VELOCITIES, gradient, theory))
    draw(
        figures / "lattice", curves, "superficial velocity [m/s]", "pressure drop over height [Pa/m]",
        logarithmic=True,
    )  # fmt: skip
    return rows


def random_bed(folder: Path, width: float, height: float, number: int, **contact: float) -> Setup:
    """A loose heap above the bottom of a box, about to settle."""
    sections = {
        "bed": {"width_m": width, "height_m": height},
        "particles": {"number": number},
        "contact": contact,
        "time": TIME,
    }
    return Setup(folder, sections, loose(width, number, DIAMETER, np.random.default_rng(1)))


def check_random(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Rows and figure of a settled random bed, held in place, with the voidage that it has."""
    settling = random_bed(work / "random_settling", BED_WIDTH, BED_HEIGHT, BED_NUMBER)
    last = run_particles(settling, SETTLE)[-1]
    spheres = at_rest(last[:, 1], last[:, 2], DIAMETER)
    setup = Setup(work / "random_held", settling.sections, spheres, {"frozen": 1})
    table = run_gas(setup, solver, len(VELOCITIES) * HOLD, steps_of_velocity())
    of = suspension(setup)
    edges = np.arange(0, spheres[:, 1].max() + DIAMETER / 2 + ROW, ROW)
    voidage = rows_of_voidage(spheres[:, 1], DIAMETER, edges, BED_WIDTH * DIAMETER)
    theory = np.array([sum(ergun_gradient(of, e, u) * ROW for e in voidage) for u in VELOCITIES])
    found = held_pressure(table)
    source = f"{ERGUN}, over rows of the measured voidage (mean {np.mean(voidage[1:-3]):.3f})"
    rows = [
        Row(f"settled bed at {u:.3g} m/s: pressure drop [Pa]", value, reference, NEAR_RANDOM, source)
        for u, value, reference in zip(VELOCITIES, found, theory, strict=True)
    ]
    curve = Curve("settled random bed", VELOCITIES, found, theory)
    draw(
        figures / "settled_bed", [curve], "superficial velocity [m/s]", "pressure drop [Pa]", logarithmic=True
    )
    return rows


def check(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Rows and figures of both."""
    return check_lattice(work, solver, figures) + check_random(work, solver, figures)
