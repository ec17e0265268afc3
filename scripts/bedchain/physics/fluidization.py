# SPDX-License-Identifier: GPL-3.0-or-later
"""Gas through a packed bed: Ergun's pressure drop, minimum fluidization, Courant number."""

import math

from bedchain.physics.constants import GRAVITY_M_S2

DENSE_VOIDAGE = 0.4  # of a packed bed: an upper estimate of the gas velocity between the particles


def courant_number(velocity: float, step: float, cell: float) -> float:
    """Courant number of the gas in a packed bed [1]: superficial `velocity` [m/s], `step` [s], `cell` [m]."""
    return velocity / DENSE_VOIDAGE * step / cell


def ergun_gradient(
    voidage: float, diameter: float, gas_density: float, viscosity: float, velocity: float
) -> float:
    """Pressure gradient of a packed bed by Ergun 1952, Chem. Eng. Prog. 48, 89 [Pa/m].

    ``150 (1 - e)^2 / e^3 mu U / d^2 + 1.75 (1 - e) / e^3 rho_g U^2 / d``.

    Parameters
    ----------
    voidage : float
        [1].
    diameter : float
        Of the spheres [m].
    gas_density, viscosity : float
        Of the gas [kg/m3], [Pa s].
    velocity : float
        Superficial [m/s].
    """
    linear, square = _ergun_factors(voidage, diameter, gas_density, viscosity)
    return linear * velocity + square * velocity**2


def ergun_velocity(
    voidage: float, diameter: float, density: float, gas_density: float, viscosity: float
) -> float:
    """Superficial velocity that fluidizes a bed [m/s]: `ergun_gradient` equals the weight of the bed.

    Parameters
    ----------
    voidage : float
        [1].
    diameter, density : float
        Of the spheres [m], [kg/m3].
    gas_density, viscosity : float
        Of the gas [kg/m3], [Pa s].
    """
    linear, square = _ergun_factors(voidage, diameter, gas_density, viscosity)
    weight = (1 - voidage) * (density - gas_density) * GRAVITY_M_S2
    # the positive root in the form that loses no digits where the viscous term rules
    return 2 * weight / (linear + math.sqrt(linear**2 + 4 * square * weight))


def _ergun_factors(
    voidage: float, diameter: float, gas_density: float, viscosity: float
) -> tuple[float, float]:
    """Factors of the velocity [Pa s/m2] and of its square [Pa s2/m3] in Ergun's equation."""
    solids = 1 - voidage
    linear = 150 * solids**2 / voidage**3 * viscosity / diameter**2
    square = 1.75 * solids / voidage**3 * gas_density / diameter
    return linear, square
