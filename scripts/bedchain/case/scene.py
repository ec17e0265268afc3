# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene of a case: the numbers that decide which physics it needs."""

from bedchain.case.schema import Case
from bedchain.errors import UserError
from bedchain.physics.packing import PACKED_AREA_SHARE, PACKED_VOLUME_SHARE, settled_height
from bedchain.physics.scene_numbers import Scene


def scene_of(case: Case) -> Scene:
    """Scene of a checked case.

    Parameters
    ----------
    case : dict
        Sections bed, particles, contact, gas, and optionally drum.

    Raises
    ------
    UserError
        The particles are not denser than the gas: nothing would settle.
    """
    bed, particles, gas, contact = case["bed"], case["particles"], case["gas"], case["contact"]
    if particles["density_kg_m3"] <= gas["density_kg_m3"]:
        raise UserError(
            f"particles.density_kg_m3 ({particles['density_kg_m3']:g}) is not above gas.density_kg_m3 "
            f"({gas['density_kg_m3']:g}): the particles would not settle; correct one of the two"
        )
    diameter, width, thickness = particles["diameter_m"], bed["width_m"], bed["thickness_m"]
    layered, solved = bed["layers"] == "many", gas["model"] != "none"
    depth = settled_height(particles["number"], diameter, width, thickness if layered else None)
    voidage = 1 - (PACKED_VOLUME_SHARE if layered else PACKED_AREA_SHARE * 2 / 3 * diameter / thickness)
    return Scene(
        diameter=diameter,
        density=particles["density_kg_m3"],
        gas_density=gas["density_kg_m3"],
        viscosity=gas["viscosity_Pa_s"],
        velocity=gas["superficial_velocity_m_s"] if solved else 0.0,
        width=width,
        thickness=thickness,
        depth=depth,
        fall=bed["height_m"] if "drum" in case else depth,
        voidage=voidage,
        young=contact["young_modulus_Pa"],
        poisson=contact["poisson_ratio_1"],
        friction=contact["friction_1"],
        rolling=contact["rolling_friction_1"],
        cell=gas["cell_size_m"],
        smoothing=gas["smoothing_diameters_1"] * diameter,
        gas=solved,
        layered=layered,
    )
