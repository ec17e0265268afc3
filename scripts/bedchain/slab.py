# SPDX-License-Identifier: GPL-3.0-or-later
"""What the thickness of the slab makes of a bed: its voidage, and the gas velocity that fluidizes it."""

import math

from bedchain.case import Case
from bedchain.case_numbers import GRAVITY_M_S2, LAYER_DISTANCE, PACKED_AREA_SHARE, PACKED_VOLUME_SHARE


def slab_voidage(area_share: float, thickness_diameters: float) -> float:
    """Voidage of one layer of spheres in a slab [1].

    Parameters
    ----------
    area_share : float
        Part of the plane that the spheres cover as discs [1].
    thickness_diameters : float
        Thickness of the slab over the diameter [1]; one in Xu, Yu 1997, Chem. Eng. Sci. 52, 2785.
    """
    return 1 - 2 / 3 * area_share / thickness_diameters


def converted_thickness(area_share: float) -> float:
    """Thickness that gives the voidage of Hoomans et al. 1996, Chem. Eng. Sci. 51, 99, in diameters [1].

    ``1 - e = 2 / sqrt(pi sqrt(3)) (1 - e_plane)^1.5`` converts a voidage in the plane to one in space. It
    makes of closest discs closest spheres, as `LAYER_DISTANCE` does, and of looser discs looser spheres.

    Parameters
    ----------
    area_share : float
        ``1 - e_plane`` [1].
    """
    solids = 2 / math.sqrt(math.pi * math.sqrt(3)) * area_share**1.5
    return 2 / 3 * area_share / solids


def ergun_velocity(
    voidage: float, diameter: float, density: float, gas_density: float, viscosity: float
) -> float:
    """Superficial velocity that fluidizes a bed by Ergun 1952, Chem. Eng. Prog. 48, 89 [m/s].

    Parameters
    ----------
    voidage : float
        [1].
    diameter, density : float
        Of the spheres [m], [kg/m3].
    gas_density, viscosity : float
        Of the gas [kg/m3], [Pa s].
    """
    solids = 1 - voidage
    linear = 150 * solids**2 / voidage**3 * viscosity / diameter**2
    square = 1.75 * solids / voidage**3 * gas_density / diameter
    weight = solids * (density - gas_density) * GRAVITY_M_S2
    return 2 * weight / (linear + math.sqrt(linear**2 + 4 * square * weight))


def fluidization_line(case: Case) -> str:
    """One line for people: the case's minimum fluidization velocity, and that of other thicknesses."""
    bed, particles, gas = case["bed"], case["particles"], case["gas"]
    diameter = particles["diameter_m"]
    spheres = (diameter, particles["density_kg_m3"], gas["density_kg_m3"], gas["viscosity_Pa_s"])
    if bed["layers"] == "many":
        speed = ergun_velocity(1 - PACKED_VOLUME_SHARE, *spheres)
        return f"u_mf about {speed:.2f} m/s (Ergun, {PACKED_VOLUME_SHARE:g} of the volume packed)"
    thicknesses = {
        "bed.thickness_m": bed["thickness_m"] / diameter,
        "conversion of Hoomans et al. 1996": converted_thickness(PACKED_AREA_SHARE),
        "layers of closest packing": LAYER_DISTANCE,
    }
    parts = []
    for name, thickness in thicknesses.items():
        speed = ergun_velocity(slab_voidage(PACKED_AREA_SHARE, thickness), *spheres)
        parts.append(f"{speed:.2f} m/s at T = {thickness:.3g} d ({name})")
    return f"u_mf about (Ergun, {PACKED_AREA_SHARE:g} of the plane covered) " + ", ".join(parts)
