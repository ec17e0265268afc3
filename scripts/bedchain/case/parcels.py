# SPDX-License-Identifier: GPL-3.0-or-later
"""The bed of parcels that is simulated in place of a case's particles (`particles.parcel_diameters`)."""

import math
from fractions import Fraction

from bedchain.case.schema import Case
from bedchain.physics.parcels import parcel_restitution, particles_in
from bedchain.physics.whole_numbers import dividing_step, ratio


def parcel_diameters(case: Case) -> float:
    """Diameter of a parcel over that of a particle [1]; 1 where a case says nothing of it."""
    return float(case["particles"].get("parcel_diameters", 1.0))


def particles_per_parcel(case: Case) -> float:
    """Particles of the bed that one parcel, a row of its frames, stands for [1]."""
    return particles_in(parcel_diameters(case), case["bed"].get("layers") == "many")


def parcel_case(case: Case) -> Case:
    """A case whose particles are the parcels that are simulated; the case itself without parcels.

    Parcels are l times as large, and l^2 times fewer in a bed of one layer, which is l times as thick, or l^3
    times fewer in a thick one. Their restitution keeps the dissipation per volume; their step is as long as l
    times the particles' where that divides the gas step. Density, stiffness, friction and gas stay.

    Parameters
    ----------
    case : dict
        Sections bed, particles, and optionally contact and time.

    Returns
    -------
    dict
        Has ``particles.parcel_diameters`` 1.
    """
    size, number = parcel_diameters(case), particles_per_parcel(case)
    if size == 1:
        return case
    bed, particles = case["bed"], case["particles"]
    parcels = {
        "bed": bed if bed["layers"] == "many" else bed | {"thickness_m": bed["thickness_m"] * size},
        "particles": particles
        | {
            "number": max(1, round(particles["number"] / number)),
            "diameter_m": particles["diameter_m"] * size,
            "parcel_diameters": 1.0,
        },
    }
    if contact := case.get("contact"):
        restitution = parcel_restitution(contact["restitution_1"], size)
        parcels["contact"] = contact | {"restitution_1": restitution}
    if time := case.get("time"):
        parcels["time"] = time | {"dem_step_s": parcel_step(case, size)}
    return case | parcels


def parcel_step(case: Case, size: float) -> float:
    """Step of parcels [s]: up to l times the particles', so that it divides gas step and time of settling."""
    time = case["time"]
    gas, settle = (ratio(time[name], 1.0) for name in ("gas_step_s", "settle_s"))
    shared = Fraction(
        math.gcd(gas.numerator * settle.denominator, settle.numerator * gas.denominator),
        gas.denominator * settle.denominator,
    )
    step = float(time["dem_step_s"])
    return max(step, dividing_step(float(shared), step * size))
