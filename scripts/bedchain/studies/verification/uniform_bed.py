# SPDX-License-Identifier: GPL-3.0-or-later
"""Pressure drop of gas through a uniform lattice of spheres held in place, over a decade of velocity."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from bedchain.dem.lattices import lattice
from bedchain.dem.small_cases import Setup, run_gas
from bedchain.studies.verification.laws import LAWS, ergun_gradient, pressure_gradient, suspension
from bedchain.studies.verification.plots import Curve, draw
from bedchain.studies.verification.rows import Row

NEAR = 0.01
ERGUN = "Ergun 1952, Chem. Eng. Prog. 48, 89, eq. (11)"
VELOCITIES = np.geomspace(0.2, 2.0, 6)  # [m/s], a decade
HOLD = 0.02  # [s] at each velocity, a hundred relaxation times of the gas
RISE = 0.002  # [s] from one velocity to the next
DIAMETER = 1e-3
WIDTH, HEIGHT = 0.02, 0.1  # [m]


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
    sections: dict[str, dict[str, Any]] = {
        "bed": {"width_m": WIDTH, "height_m": HEIGHT},
        "particles": {"number": 1},
        "gas": {"drag_law": law},
        "time": {"frame_interval_s": HOLD},
    }
    spheres = lattice(WIDTH, HEIGHT, DIAMETER, DIAMETER)
    return Setup(folder, sections, spheres, {"frozen": 1, "number": len(spheres)})


def check(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Rows and figure of the lattice: Ergun over a decade of velocity, and each law's own pressure drop."""
    rows, curves = [], []
    voidage = 1 - np.pi / 6
    for name, law in LAWS.items():
        setup = lattice_setup(work / f"lattice_{name}", name)
        drops = held_pressure(run_gas(setup, solver, len(VELOCITIES) * HOLD, steps_of_velocity()))
        of = suspension(setup)
        theory = np.array([pressure_gradient(law, of, voidage, u) for u in VELOCITIES])
        if name == "gidaspow":
            theory, source = np.array([ergun_gradient(of, voidage, u) for u in VELOCITIES]), ERGUN
        else:
            source = f"{name} drag law, dp/dz = beta u / e (model A)"
        gradient = drops / HEIGHT
        for velocity, value, reference in zip(VELOCITIES, gradient, theory, strict=True):
            if name == "gidaspow" or velocity == VELOCITIES[-1]:
                quantity = f"lattice at {velocity:.3g} m/s, {name}: pressure drop over height [Pa/m]"
                rows.append(Row(quantity, value, reference, NEAR, source))
        curves.append(Curve(name, VELOCITIES, gradient, theory))
    draw(
        figures / "lattice", curves, "superficial velocity [m/s]", "pressure drop over height [Pa/m]",
        logarithmic=True,
    )  # fmt: skip
    return rows
