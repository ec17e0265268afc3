# SPDX-License-Identifier: GPL-3.0-or-later
"""Contacts of spheres: Rayleigh time, contact modulus, overlap at rest."""

import math

from bedchain.physics.constants import GRAVITY_M_S2


def rayleigh_time(young: float, poisson: float, density: float, radius: float) -> float:
    """Time that a surface wave takes over a sphere [s]: it limits the DEM step.

    ``pi r sqrt(rho / G) / (0.1631 nu + 0.8766)``, ``G = E / (2 (1 + nu))`` (Thornton, Randall 1988).

    Parameters
    ----------
    young : float
        Young's modulus [Pa].
    poisson : float
        Poisson's ratio [1].
    density : float
        Density of the sphere [kg/m3].
    radius : float
        Radius [m].
    """
    shear = young / (2 * (1 + poisson))
    return math.pi * radius * math.sqrt(density / shear) / (0.1631 * poisson + 0.8766)


def contact_modulus(young: float, poisson: float) -> float:
    """Modulus of a contact of equal materials [Pa], ``E / (2 (1 - nu^2))`` (Johnson 1985, ch. 4)."""
    return young / (2 * (1 - poisson**2))


def static_overlap(
    young: float, poisson: float, density: float, diameter: float, number: int, width: float, depth: float
) -> float:
    """Overlap of two particles under the weight of a settled bed, over the diameter [1].

    ``(3 F / (4 E* sqrt(R*)))^(2/3) / d``, Hertz (Johnson 1985, Contact Mechanics, ch. 4); ``R* = d / 4``,
    and F the load on a particle of the lowest layer, ``W d / width`` in a bed of one layer and
    ``W d^2 / (width depth)`` in a deeper one, for a bed of weight W.

    Parameters
    ----------
    young, poisson : float
        Young's modulus [Pa], Poisson's ratio [1].
    density, diameter : float
        Of the particles [kg/m3], [m].
    number : int
        Number of particles [1].
    width, depth : float
        Of the bed [m]; a depth below one diameter stands for one layer.
    """
    weight = number * density * math.pi / 6 * diameter**3 * GRAVITY_M_S2
    load = weight * diameter / width * min(1.0, diameter / depth)
    modulus = contact_modulus(young, poisson)
    return (3 * load / (4 * modulus * math.sqrt(diameter / 4))) ** (2 / 3) / diameter
