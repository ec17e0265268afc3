# SPDX-License-Identifier: GPL-3.0-or-later
"""Contacts alone: two spheres that collide head on, and one that slides on the bottom until it rolls."""

from pathlib import Path

import numpy as np

from bedchain.verification.bench import Setup, run_particles
from bedchain.verification.laws import GRAVITY
from bedchain.verification.plots import Curve, draw
from bedchain.verification.rows import Row

NEAR = 0.01
ROUND_OFF = 1e-12
RESTITUTIONS = (0.3, 0.6, 0.9, 1.0)
SPHERE, LARGE = 1e-3, 2e-3  # diameters [m]: unequal masses
SPEED = 0.5  # [m/s], of either sphere before the impact
YOUNG, POISSON, DENSITY, FRICTION = 5e6, 0.3, 2600.0, 0.3
WIDTH, HEIGHT = 0.02, 0.02  # [m]
STEP = 2e-6  # [s], 3 % of the Rayleigh time: an impact takes about a hundred steps
SLIDE_SPEED = 0.1  # [m/s]
SLIDE = 0.02  # [s], twice the time of sliding


def case_sections(frame_s: float, **contact: float) -> dict[str, dict[str, float]]:
    """Sections of the case file that both checks share."""
    return {
        "bed": {"width_m": WIDTH, "height_m": HEIGHT},
        "particles": {"density_kg_m3": DENSITY, "diameter_m": SPHERE},
        "contact": {"young_modulus_Pa": YOUNG, "poisson_ratio_1": POISSON, "friction_1": FRICTION} | contact,
        "time": {"dem_step_s": STEP, "gas_step_s": 2e-5, "frame_interval_s": frame_s},
    }


def impact(work: Path, restitution: float) -> np.ndarray:
    """Velocities along x [m/s] of the two spheres before and after, (2, 2), without weight."""
    gap = 0.5 * (SPHERE + LARGE) + 1e-4
    spheres = np.array([[0.008, 0.01, SPEED, 0, SPHERE], [0.008 + gap, 0.01, -SPEED, 0, LARGE]])
    folder = work / f"impact_{restitution:g}"
    sections = case_sections(2e-3, restitution_1=restitution)
    frames = run_particles(Setup(folder, sections, spheres, {"gravity": 0.0}), 2e-3)
    return frames[[0, -1], :, 3]


def check_impact(work: Path, figures: Path) -> list[Row]:
    """Rows and figure of the head-on impact of unequal spheres."""
    masses = np.array([SPHERE, LARGE]) ** 3
    rows, found = [], []
    for restitution in RESTITUTIONS:
        before, after = impact(work, restitution)
        ratio = (after[1] - after[0]) / (before[0] - before[1])
        change = abs(masses @ (after - before)) / (masses @ np.abs(before))
        source = "definition: separation over approach speed; the coefficient given to the contact law"
        rows.append(
            Row(f"restitution of an impact given as {restitution:g} [1]", ratio, restitution, NEAR, source)
        )
        quantity = f"momentum change in it over the momentum of either way, {restitution:g} [1]"
        rows.append(Row(quantity, change, 0, ROUND_OFF, "Newton's third law"))
        found.append(ratio)
    given = np.array(RESTITUTIONS)
    curve = Curve("head-on impact", given, np.array(found), given)
    draw(figures / "impact", [curve], "restitution given [1]", "restitution recovered [1]")
    return rows


def rolling_velocity(times: np.ndarray) -> np.ndarray:
    """Velocity of a sphere that starts to slide without spin [m/s]: friction until it rolls at 5/7."""
    return np.maximum(SLIDE_SPEED - FRICTION * GRAVITY * times, 5 / 7 * SLIDE_SPEED)


def check_rolling(work: Path, figures: Path) -> list[Row]:
    """Rows and figure of the sphere that slides on the bottom until it rolls."""
    radius, mass = SPHERE / 2, DENSITY * np.pi / 6 * SPHERE**3
    modulus = YOUNG / (2 * (1 - POISSON**2))
    # Hertz: the overlap at which the bottom carries the weight
    overlap = (mass * GRAVITY / (4 / 3 * modulus * radius**0.5)) ** (2 / 3)
    spheres = np.array([[0.005, radius - overlap, SLIDE_SPEED, 0, SPHERE]])
    frame = 2e-4
    frames = run_particles(Setup(work / "rolling", case_sections(frame), spheres), SLIDE)[:, 0]
    times = frame * np.arange(len(frames))
    velocity, spin = frames[:, 3], frames[:, 5]
    theory = rolling_velocity(times)
    gap = float(np.abs(velocity - theory).max() / SLIDE_SPEED)
    source = "friction mu g until v = omega r, angular momentum about the contact kept: v = 5/7 v0"
    draw(
        figures / "rolling", [Curve("sphere on the bottom", times, velocity, theory)],
        "time [s]", "velocity [m/s]",
    )  # fmt: skip
    return [
        Row("velocity of rolling over that of sliding [1]", velocity[-1] / SLIDE_SPEED, 5 / 7, NEAR, source),
        Row(
            "spin times radius over velocity at the end [1]",
            spin[-1] * radius / velocity[-1],
            1,
            NEAR,
            source,
        ),
        Row("largest gap of the velocity on the way over its start [1]", gap, 0, NEAR, source),
    ]


def check(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Rows and figures of both; they need no gas."""
    return check_impact(work, figures) + check_rolling(work, figures)
