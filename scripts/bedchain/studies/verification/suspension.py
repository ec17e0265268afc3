# SPDX-License-Identifier: GPL-3.0-or-later
"""A uniform suspension that sinks in a box closed below, so that the displaced gas rises through it.

With spheres sinking at w, the closed gas balance gives the gas a velocity ``(1 - e) w / e`` upwards and a
slip ``w / e``. Without d(voidage)/dt in the balance the gas would stay at rest and the spheres sink faster.
"""

from pathlib import Path
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from bedchain.dem.lattices import lattice
from bedchain.dem.particle_files import read_frames
from bedchain.dem.small_cases import Setup, run_gas
from bedchain.studies.verification.laws import LAWS, Suspension, drag_coefficient, suspension
from bedchain.studies.verification.plots import Curve, draw
from bedchain.studies.verification.rows import Row
from bedchain.uncertainty.bands import mean_error

NEAR = 0.01
LAW = "beetstra"
WIDTH, HEIGHT, DIAMETER, SPACING = 0.02, 0.1, 1e-3, 1.25e-3  # [m], four spheres to a cell
VISCOSITY = 1.8e-3  # [Pa s], a hundred times that of air: the end velocity is reached within a cell
DURATION, FRAME = 0.08, 2e-3  # [s]
MIDDLE = (0.4, 0.6)  # of the height, where neither the bottom nor the top is felt yet
STEP = 1e-4  # [s], of the gas, a hundredth of the relaxation time
SOURCE = (
    "closed gas balance: gas rises at (1-e) w/e; (m + rho V (1-e)/e) dw/dt = (m - rho V) g - K(w/e) w/e^2,"
    " integrated with scipy; K by Beetstra et al. 2007"
)


def sinking_speed(of: Suspension, e: float, times: np.ndarray) -> np.ndarray:
    """Speed of the suspension [m/s] at these times [s], integrated with scipy."""
    inertia = of.mass + of.gas_density * of.volume * (1 - e) / e

    def gain(_: float, speed: np.ndarray) -> list[float]:
        slip = speed[0] / e
        return [(of.weight - drag_coefficient(LAWS[LAW], of, e, slip) * slip / e) / inertia]

    solution = solve_ivp(gain, (0, times[-1]), [0.0], t_eval=times, method="LSODA", rtol=1e-9, atol=1e-12)
    return np.asarray(solution.y[0])


def run_suspension(folder: Path, solver: Path) -> tuple[np.ndarray, ...]:
    """Times [s] of the frames, speed of each sphere in the middle of the box and that of the theory [m/s]."""
    sections: dict[str, dict[str, Any]] = {
        "bed": {"width_m": WIDTH, "height_m": HEIGHT},
        "particles": {"number": 1, "diameter_m": DIAMETER},
        "gas": {"drag_law": LAW, "viscosity_Pa_s": VISCOSITY, "superficial_velocity_m_s": 0.0},
        "time": {"gas_step_s": STEP, "frame_interval_s": FRAME},
    }
    spheres = lattice(WIDTH, HEIGHT, SPACING, DIAMETER)
    setup = Setup(folder, sections, spheres, {"number": len(spheres)})
    run_gas(setup, solver, DURATION, "constant 0", row_every=10, slip=True)
    frames = read_frames(setup.folder)
    low, high = (share * HEIGHT for share in MIDDLE)
    of_middle = (frames[-1, :, 2] > low) & (frames[-1, :, 2] < high)
    times = FRAME * np.arange(len(frames))
    speed = -frames[:, of_middle, 4]
    voidage = 1 - np.pi / 6 * DIAMETER**2 / SPACING**2
    return times, speed, sinking_speed(suspension(setup), voidage, times)


def check(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Rows and figure of the sinking suspension."""
    times, of_middle, theory = run_suspension(work / "suspension", solver)
    speed, error = of_middle.mean(axis=1), float(mean_error(of_middle[-1]))
    gap = float(np.abs(speed - theory).max() / theory[-1])
    curve = Curve("middle of the box", times, speed, theory)
    draw(figures / "suspension", [curve], "time [s]", "sinking speed of a suspension [m/s]")
    return [
        Row("sinking speed of a uniform suspension [m/s]", speed[-1], theory[-1], NEAR, SOURCE, error),
        Row("largest gap on the way there over it, suspension [1]", gap, 0, NEAR, SOURCE),
    ]
