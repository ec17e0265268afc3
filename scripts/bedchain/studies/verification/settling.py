# SPDX-License-Identifier: GPL-3.0-or-later
"""Fall of a single sphere through gas at rest: speed over time and terminal speed, for each drag law."""

from pathlib import Path
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from bedchain.dem.small_cases import Setup, run_gas
from bedchain.studies.verification.laws import LAWS, Law, Suspension, drag_coefficient, suspension
from bedchain.studies.verification.plots import Curve, draw
from bedchain.studies.verification.rows import Row

NEAR = 0.01
SOURCE = "m dv/dt = (m - rho V) g - K(v) v, integrated with scipy; K by {}"
WIDTH, HEIGHT, THICKNESS, CELL = 0.2, 10.0, 1.0, 0.1  # [m]: the gas of one cell weighs 10 000 spheres
START_X, START_Z = 0.09, 9.93  # [m], between centres of cells
STEP = 4e-3  # [s], of the gas and of the exchange, a hundredth of the relaxation time
DEM_STEPS = 50  # in one of the gas: a sphere that touches nothing needs no more
DURATION = 2.0  # [s], five times the relaxation time
ALONE = 1 - 1e-9  # voidage around one sphere


def falling_speed(law: Law, of: Suspension, times: np.ndarray) -> np.ndarray:
    """Speed of a sphere that starts at rest [m/s], integrated with scipy."""

    def gain(_: float, speed: np.ndarray) -> list[float]:
        drag = drag_coefficient(law, of, ALONE, speed[0]) * speed[0]
        return [(of.weight - drag) / of.mass]

    solution = solve_ivp(gain, (0, times[-1]), [0.0], t_eval=times, rtol=1e-9, atol=1e-12)
    return np.asarray(solution.y[0])


def terminal_speed(law: Law, of: Suspension) -> float:
    """Speed at which drag carries the sphere [m/s]."""
    return float(brentq(lambda speed: drag_coefficient(law, of, ALONE, speed) * speed - of.weight, 1e-6, 1e3))


def setup_of(folder: Path, law: str, step: float = STEP) -> Setup:
    """A light sphere in a wide, high and thick box, with a step of the gas [s]."""
    sections: dict[str, dict[str, Any]] = {
        "bed": {"width_m": WIDTH, "height_m": HEIGHT, "thickness_m": THICKNESS},
        "particles": {"density_kg_m3": 1000.0},
        "gas": {
            "cell_size_m": CELL,
            "drag_law": law,
            "smoothing_diameters_1": 0,
            "superficial_velocity_m_s": 0.0,
        },
        "time": {
            "dem_step_s": step / DEM_STEPS,
            "gas_step_s": step,
            "frame_interval_s": 0.5,
            "allow_unstable_step": True,
        },
    }
    # A skin of a gas cell: bins of the size of a sphere would take most of the time
    return Setup(folder, sections, np.array([[START_X, START_Z, 0.0, 0.0, 1e-3]]), {"skin": CELL})


def fall(setup: Setup, solver: Path, law: Law, duration: float, row_every: int) -> tuple[np.ndarray, ...]:
    """Times [s], the sphere's speed and that of the theory [m/s]."""
    table = run_gas(setup, solver, duration, "constant 0", row_every)
    of = suspension(setup)
    times = table["time_s"].to_numpy()
    speed = np.sqrt(2 * table["kinetic_energy_J"].to_numpy() / of.mass)
    return times, speed, falling_speed(law, of, times)


def speed_gap(work: Path, solver: Path, step: float, duration: float) -> float:
    """Error of the speed in the middle of the fall over the theory's, for a step of the exchange [1]."""
    setup = setup_of(work / f"settling_{step:g}", "wen_yu", step)
    _, speed, theory = fall(setup, solver, LAWS["wen_yu"], duration, 1)
    return float(abs(speed[-1] / theory[-1] - 1))


def check(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Rows and figure of the falling sphere."""
    rows, curves = [], []
    for name, law in LAWS.items():
        setup = setup_of(work / f"settling_{name}", name)
        times, speed, expected = fall(setup, solver, law, DURATION, row_every=5)
        terminal = terminal_speed(law, suspension(setup))
        source = SOURCE.format(name)
        gap = float(np.abs(speed - expected).max() / terminal)
        rows.append(Row(f"terminal velocity, {name} [m/s]", speed[-1], terminal, NEAR, source))
        rows.append(Row(f"largest gap on the way there over it, {name} [1]", gap, 0, NEAR, source))
        curves.append(Curve(name, times, speed, expected))
    draw(figures / "settling", curves, "time [s]", "speed of a falling sphere [m/s]")
    return rows
