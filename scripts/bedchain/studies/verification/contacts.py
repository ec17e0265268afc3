# SPDX-License-Identifier: GPL-3.0-or-later
"""Contacts alone: two spheres that collide head on, and a sphere that slides on the bottom until it rolls."""

from pathlib import Path
from typing import Any

import numpy as np

from bedchain.case.bed_checks import RAYLEIGH_SHARE_MAX
from bedchain.dem.small_cases import Setup, run_particles
from bedchain.physics.contacts import rayleigh_time
from bedchain.physics.whole_numbers import rounded_down
from bedchain.studies.verification.laws import GRAVITY
from bedchain.studies.verification.plots import Curve, draw
from bedchain.studies.verification.rows import Row

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
MODULUS = YOUNG / (2 * (1 - POISSON**2))  # of two spheres that touch [Pa]
LAWS = ("hertz", "hooke")
SQUEEZE = 4e-4  # [s]: until two spheres have met and parted
FINE_FRAME = 4e-6  # [s], a fiftieth of an impact
ROLLING_FRICTION = 0.1
# impacts resolved by few steps: particles as soft as a bed of two cores carries
LONG_STEP, LONG_STEPS, SOFT, PAIRS = RAYLEIGH_SHARE_MAX, 50, 1.9e5, 15
SPEEDS = (0.05, 0.2, 0.5)  # [m/s], of either sphere
SCATTER = 0.06
LATE = 0.7  # share of `SLIDE` after which the sphere rolls, resisted or not


def case_sections(frame_s: float, **contact: float | str) -> dict[str, dict[str, Any]]:
    """Sections of the case file that the checks share."""
    return {
        "bed": {"width_m": WIDTH, "height_m": HEIGHT},
        "particles": {"density_kg_m3": DENSITY, "diameter_m": SPHERE},
        "contact": {"young_modulus_Pa": YOUNG, "poisson_ratio_1": POISSON, "friction_1": FRICTION} | contact,
        "time": {"dem_step_s": STEP, "gas_step_s": min(2e-5, frame_s), "frame_interval_s": frame_s},
    }


def head_on(folder: Path, diameter: float, span: float, sections: dict[str, dict[str, Any]]) -> np.ndarray:
    """Frames of a head-on impact of a sphere on one of a diameter [m], without weight, (n_frames, 2, 6)."""
    gap = 0.5 * (SPHERE + diameter) + 1e-4
    spheres = np.array([[0.008, 0.01, SPEED, 0, SPHERE], [0.008 + gap, 0.01, -SPEED, 0, diameter]])
    return run_particles(Setup(folder, sections, spheres, {"gravity": 0.0}), span)


def impact(work: Path, restitution: float) -> np.ndarray:
    """Velocities along x [m/s] of two unequal spheres before and after an impact, (2, 2)."""
    sections = case_sections(2e-3, restitution_1=restitution)
    return head_on(work / f"impact_{restitution:g}", LARGE, 2e-3, sections)[[0, -1], :, 3]


def check_impact(work: Path, figures: Path) -> list[Row]:
    """Rows and figure of the head-on impact of unequal spheres."""
    masses = np.array([SPHERE, LARGE]) ** 3
    rows, ratios = [], []
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
        ratios.append(ratio)
    given = np.array(RESTITUTIONS)
    curve = Curve("head-on impact", given, np.array(ratios), given)
    draw(figures / "impact", [curve], "restitution given [1]", "restitution recovered [1]")
    return rows


def long_step_restitutions(folder: Path, speed: float, restitution: float) -> np.ndarray:
    """Restitution of head-on impacts [1] that differ in how far a step reaches into the contact, (n_pairs,).

    The step is the largest that a case may have, `LONG_STEP` of the Rayleigh time.
    """
    step = float(rounded_down(LONG_STEP * rayleigh_time(SOFT, POISSON, DENSITY, SPHERE / 2)))
    span = round(LONG_STEPS * step, 12)  # a whole number of steps in decimals too
    sections = case_sections(span, restitution_1=restitution, young_modulus_Pa=SOFT)
    sections["time"] |= {"dem_step_s": step, "gas_step_s": step}
    gaps = 1.01 * SPHERE + 2 * speed * step * np.arange(PAIRS) / PAIRS
    heights = 1.2 * SPHERE * (1 + np.arange(PAIRS))
    left = [[0.008, height, speed, 0, SPHERE] for height in heights]
    right = [[0.008 + gap, height, -speed, 0, SPHERE] for gap, height in zip(gaps, heights, strict=True)]
    frames = run_particles(Setup(folder, sections, np.array(left + right), {"gravity": 0.0}), span)
    parting = frames[-1, PAIRS:, 3] - frames[-1, :PAIRS, 3]
    return parting / (2 * speed)


def check_long_step(work: Path) -> list[Row]:
    """Rows of impacts by the longest step that a case may have: their mean, and the one farthest from it."""
    rows, given = [], 0.9
    for speed in SPEEDS:
        ratios = long_step_restitutions(work / f"long_step_{speed:g}", speed, given)
        quantity = (
            f"of {PAIRS} impacts at {2 * speed:g} m/s by steps of {100 * LONG_STEP:g} % of the Rayleigh time"
        )
        source = "definition, as above; the phase of the step in the contact varies"
        error = float(ratios.std(ddof=1) / np.sqrt(PAIRS))
        rows.append(Row(f"restitution {quantity}, mean [1]", ratios.mean(), given, NEAR, source, error))
        farthest = float(np.abs(ratios - given).max())
        rows.append(Row(f"restitution {quantity}, largest difference [1]", farthest, 0, SCATTER, source))
    return rows


def deepest_overlap(law: str) -> float:
    """Largest overlap of two equal spheres without damping [m], by theory.

    Hertz: by the energy (Johnson 1985, Contact Mechanics, ch. 11). Hooke: in proportion to the speed, with a
    spring as stiff as that of Hertz in an impact at the speed sqrt(g W).
    """
    mass = DENSITY * np.pi / 6 * SPHERE**3 / 2  # reduced, as is the radius of the contact
    stiffness = 16 / 15 * MODULUS * (SPHERE / 4) ** 0.5
    approach = 2 * SPEED
    matched = np.sqrt(GRAVITY * WIDTH) if law == "hooke" else approach
    return float((mass * matched**2 / stiffness) ** 0.4 * approach / matched)


def check_overlap(work: Path) -> list[Row]:
    """Rows of the largest overlap of equal spheres by either law."""
    rows = []
    for law in LAWS:
        sections = case_sections(FINE_FRAME, restitution_1=1.0, law=law)
        frames = head_on(work / f"overlap_{law}", SPHERE, SQUEEZE, sections)
        deepest = SPHERE - np.diff(frames[:, :, 1]).min()
        theory = deepest_overlap(law)
        source = "energy of the spring; hooke: as deep as hertz at sqrt(g W), in proportion to the speed"
        quantity = f"largest overlap of an impact by {law} over the diameter [1]"
        rows.append(Row(quantity, deepest / SPHERE, theory / SPHERE, NEAR, source))
    return rows


def rolling_velocity(times: np.ndarray, resistance: float) -> np.ndarray:
    """Velocity of a sphere that starts to slide without spin [m/s], by its rolling friction [1]."""
    spin_up = 5 / 2 * (FRICTION - resistance) * GRAVITY  # of its surface [m/s2]
    met = SLIDE_SPEED / (FRICTION * GRAVITY + spin_up)
    sliding = SLIDE_SPEED - FRICTION * GRAVITY * np.minimum(times, met)
    return sliding - 5 / 7 * resistance * GRAVITY * np.maximum(times - met, 0.0)


def slide(folder: Path, resistance: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times [s], velocities [m/s] and surface velocities of the spin [m/s] of a sphere on the bottom."""
    radius, mass = SPHERE / 2, DENSITY * np.pi / 6 * SPHERE**3
    # Hertz: the overlap at which the bottom carries the weight
    overlap = (mass * GRAVITY / (4 / 3 * MODULUS * radius**0.5)) ** (2 / 3)
    spheres = np.array([[0.005, radius - overlap, SLIDE_SPEED, 0, SPHERE]])
    frame = 2e-4
    sections = case_sections(frame, rolling_friction_1=resistance)
    frames = run_particles(Setup(folder, sections, spheres), SLIDE)[:, 0]
    return frame * np.arange(len(frames)), frames[:, 3], frames[:, 5] * radius


def check_rolling(work: Path, figures: Path) -> list[Row]:
    """Rows and figure of the sphere that slides on the bottom until it rolls, freely or resisted."""
    times, velocity, surface = slide(work / "rolling", 0.0)
    theory = rolling_velocity(times, 0.0)
    gap = float(np.abs(velocity - theory).max() / SLIDE_SPEED)
    _, braked, _ = slide(work / "rolling_resistance", ROLLING_FRICTION)
    braked_theory = rolling_velocity(times, ROLLING_FRICTION)
    late = times > LATE * SLIDE
    slope = np.polyfit(times[late], braked[late], 1)[0]
    source = "friction mu g until v = omega r, angular momentum about the contact kept: v = 5/7 v0"
    draw(
        figures / "rolling",
        [
            Curve("sphere on the bottom", times, velocity, theory),
            Curve(f"rolling friction {ROLLING_FRICTION:g}", times, braked, braked_theory),
        ],
        "time [s]", "velocity [m/s]",
    )  # fmt: skip
    braking = f"deceleration of rolling with rolling friction {ROLLING_FRICTION:g} over gravity [1]"
    torque = "torque mu_r m g r about the contact: 5/7 mu_r g"
    return [
        Row("velocity of rolling over that of sliding [1]", velocity[-1] / SLIDE_SPEED, 5 / 7, NEAR, source),
        Row("spin times radius over velocity at the end [1]", surface[-1] / velocity[-1], 1, NEAR, source),
        Row("largest gap of the velocity on the way over its start [1]", gap, 0, NEAR, source),
        Row(braking, -slope / GRAVITY, 5 / 7 * ROLLING_FRICTION, NEAR, torque),
    ]


def check(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Rows and figures of all contacts; they need no gas."""
    return (
        check_impact(work, figures)
        + check_long_step(work)
        + check_overlap(work)
        + check_rolling(work, figures)
    )
