# SPDX-License-Identifier: GPL-3.0-or-later
"""Orders of convergence: of the grid on a manufactured voidage, of the exchange on a falling sphere."""

from pathlib import Path

import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.optimize import brentq

from bedchain.dem.lattices import spheres_at_rest
from bedchain.dem.small_cases import Setup, run_gas
from bedchain.studies.verification.laws import Suspension, ergun_gradient
from bedchain.studies.verification.plots import Curve, draw
from bedchain.studies.verification.rows import Row
from bedchain.studies.verification.settled_bed import rows_of
from bedchain.studies.verification.settling import speed_gap

NEAR = 0.15  # of the order: the coarsest grid has ten cells on the wave
WIDTH, HEIGHT, DIAMETER = 0.004, 0.2, 4e-4  # [m]
COLUMNS = 8  # of spheres across
SOLIDS, WAVE = 0.36, 0.1  # mean share of the solids, and how much it varies along the height
VELOCITY = 0.5  # [m/s]
CELLS = (10, 20, 40)  # along the height
HELD = 0.02  # [s]
STEPS = (1e-2, 5e-3, 2.5e-3)  # [s], of the exchange, against a relaxation time of 0.4 s
FALL = 0.5  # [s]
POINTS = 4001  # of the quadrature


def solids_at(z: np.ndarray) -> np.ndarray:
    """The manufactured share of the solids: level at either end [1]."""
    return np.asarray(SOLIDS * (1 + WAVE * np.cos(2 * np.pi * z / HEIGHT)))


def graded_lattice() -> np.ndarray:
    """Spheres in columns whose spacing along the height follows the manufactured share of the solids."""
    per_row = COLUMNS * np.pi / 6 * DIAMETER**3 / (WIDTH * DIAMETER)  # height of the solids of one row [m]
    rows = int(SOLIDS * HEIGHT / per_row)

    def below(z: float) -> float:
        return SOLIDS * (z + WAVE * HEIGHT / (2 * np.pi) * np.sin(2 * np.pi * z / HEIGHT))

    total = below(HEIGHT)
    z = [brentq(lambda at, k=k: below(at) - (k + 0.5) / rows * total, 0, HEIGHT) for k in range(rows)]
    height, x = np.meshgrid(z, (np.arange(COLUMNS) + 0.5) * WIDTH / COLUMNS, indexing="ij")
    return spheres_at_rest(x.ravel(), height.ravel(), DIAMETER)


def exact_pressure(of: Suspension, z: np.ndarray, share: float) -> np.ndarray:
    """Pressure of the steady gas over heights [Pa]: Ergun and the gas's own inertia, in one dimension.

    ``d(e u^2)/dz = -e/rho dp/dz - beta u/rho`` with ``e u = U``; `share` corrects for whole rows of spheres.
    """
    points = np.linspace(0, HEIGHT, POINTS)
    e = 1 - share * solids_at(points)
    inertia = of.gas_density * VELOCITY * np.gradient(VELOCITY / e, points) / e
    gradient = np.array([ergun_gradient(of, voidage, VELOCITY) for voidage in e]) + inertia
    rising = cumulative_trapezoid(gradient, points, initial=0)
    return np.interp(z, points, rising[-1] - rising)


def grid_error(work: Path, solver: Path, cells: int) -> float:
    """Root mean square error of the pressure over the pressure drop, on so many cells [1]."""
    spheres = graded_lattice()
    sections = {
        "bed": {"width_m": WIDTH, "height_m": HEIGHT, "thickness_m": DIAMETER},
        "particles": {"number": 1, "diameter_m": DIAMETER},
        "gas": {"cell_size_m": WIDTH, "smoothing_diameters_1": 0, "superficial_velocity_m_s": VELOCITY},
        "contact": {"young_modulus_Pa": 2e5},
        "time": {"frame_interval_s": HELD},
    }
    numbers = {"frozen": 1, "number": len(spheres), "gas_cells_x": 1, "gas_cells_z": cells}
    setup = Setup(work / f"graded_{cells}", sections, spheres, numbers)
    run_gas(setup, solver, HELD, f"constant {VELOCITY}", tight=True, slip=True)
    of = Suspension(DIAMETER, 2600.0, 1.2, 1.8e-5)
    pressure = of.gas_density * rows_of(setup.folder / "gas", "p")[:, 0]
    z = (np.arange(cells) + 0.5) * HEIGHT / cells
    share = len(spheres) * of.volume / (WIDTH * DIAMETER * SOLIDS * HEIGHT)
    exact = exact_pressure(of, z, share)
    return float(np.sqrt(((pressure - exact) ** 2).mean()) / exact_pressure(of, np.zeros(1), share)[0])


def order(errors: np.ndarray) -> float:
    """Order by the last two errors of a series in which each width is half of that before."""
    return float(np.log2(errors[-2] / errors[-1]))


def check(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Rows and figure of both orders."""
    grid = np.array([grid_error(work, solver, cells) for cells in CELLS])
    time = np.array([speed_gap(work, solver, step, FALL) for step in STEPS])
    widths, steps = 1 / np.array(CELLS), np.array(STEPS) / max(STEPS) / CELLS[0]
    curves = [
        Curve("cells, manufactured voidage", widths, grid, grid[-1] * (widths / widths[-1]) ** 2),
        Curve("steps, falling sphere", steps, time, time[-1] * (steps / steps[-1])),
    ]
    label = "width of a cell over the height; step, scaled [1]"
    draw(figures / "convergence", curves, label, "error [1]", logarithmic=True, line="order 2 and 1")
    return [
        Row("order of the grid, pressure on a smooth voidage [1]", order(grid), 2, NEAR,
            "one-dimensional momentum, model A, by quadrature; linear interpolation"),
        Row("order of the exchange step, speed of a falling sphere [1]", order(time), 1, NEAR,
            "implicit Euler; reference integrated with scipy"),
    ]  # fmt: skip
