# SPDX-License-Identifier: GPL-3.0-or-later
"""Head-on collisions of two equal spheres by LIGGGHTS alone, and a check of their restitution."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bedchain.dem.small_cases import Setup, run_particles
from bedchain.errors import CaseError, UserError
from bedchain.physics.whole_numbers import nearest_multiple
from bedchain.studies.stability.beds import DENSITY, DIAMETER, POISSON
from bedchain.studies.stability.verdict import Verdict, judge, refused, stopped
from bedchain.studies.verification.rows import Row

RESTITUTION, NEAR = 0.9, 0.05
PAIRS = 8  # each meets at another moment within a step, which with long steps decides the overlap
BOX = 0.02  # [m]
GAP = 5e-5  # [m], the smallest between two spheres at the start
DURATIONS = 4  # of the collision, that are simulated after the first touch


@dataclass(frozen=True)
class Collision:
    """Two spheres that meet.

    Attributes
    ----------
    young : float
        [Pa].
    step : float
        Of the particles [s].
    speed : float
        At which they approach each other [m/s].
    duration : float
        Of the collision by theory [s].
    allowed : bool
        `time.allow_unstable_step`.
    """

    young: float
    step: float
    speed: float
    duration: float
    allowed: bool = False


def run_collision(folder: Path, collision: Collision) -> Verdict:
    """Verdict of the worst restitution of some colliding pairs.

    Parameters
    ----------
    folder : Path
        To work in.
    collision : Collision
    """
    spheres = pairs(collision)
    time = (GAP + collision.speed * collision.step) / collision.speed + DURATIONS * collision.duration
    span = nearest_multiple(2 * time, collision.step)
    sections: dict[str, dict[str, Any]] = {
        "bed": {"width_m": BOX, "height_m": BOX},
        "particles": {"density_kg_m3": DENSITY, "diameter_m": DIAMETER},
        "contact": {
            "young_modulus_Pa": collision.young, "poisson_ratio_1": POISSON, "restitution_1": RESTITUTION,
        },
        "gas": {"superficial_velocity_m_s": 0.0, "cell_size_m": BOX},
        "time": {
            "dem_step_s": collision.step, "gas_step_s": collision.step, "frame_interval_s": span,
            "allow_unstable_step": collision.allowed,
        },
    }  # fmt: skip
    try:
        frames = run_particles(Setup(folder, sections, spheres, {"gravity": 0.0}), span)
    except CaseError as error:
        return refused(error)
    except UserError as error:
        return stopped(str(error))
    apart = (frames[-1, 1::2, 3] - frames[-1, ::2, 3]) / collision.speed
    worst = float(apart[np.argmax(np.abs(apart - RESTITUTION))])
    source = "definition: separation over approach speed; the coefficient given to the contact law"
    return judge([Row("restitution [1]", worst, RESTITUTION, NEAR, source)], {"restitution_1": worst})


def pairs(collision: Collision) -> np.ndarray:
    """Spheres of `PAIRS` pairs, one above the other, each by a fraction of a step further apart.

    Returns
    -------
    (2 PAIRS, 5) ndarray
        x, z [m], vx, vz [m/s] and diameter [m]; the left one of each pair first.
    """
    rows = []
    for pair in range(PAIRS):
        z = (pair + 0.5) * 2 * DIAMETER
        gap = GAP + pair / PAIRS * collision.speed * collision.step
        middle = BOX / 2
        for side in (-1, 1):
            x = middle + side * (DIAMETER + gap) / 2
            rows.append([x, z, -side * collision.speed / 2, 0.0, DIAMETER])
    return np.array(rows)
