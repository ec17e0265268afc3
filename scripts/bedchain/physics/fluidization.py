# SPDX-License-Identifier: GPL-3.0-or-later
"""Gas through a packed bed: minimum fluidization and the Courant number."""

import math

from bedchain.physics.constants import GRAVITY_M_S2

DENSE_VOIDAGE = 0.4  # of a packed bed; makes the estimate of the gas velocity between particles a high one


def courant_number(velocity: float, step: float, cell: float) -> float:
    """Courant number of the gas in a packed bed [1]: superficial `velocity` [m/s], `step` [s], `cell` [m]."""
    return velocity / DENSE_VOIDAGE * step / cell


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
