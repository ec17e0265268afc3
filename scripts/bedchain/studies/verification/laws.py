# SPDX-License-Identifier: GPL-3.0-or-later
"""Drag laws and packed-bed formulas, written from the papers independently of the solver.

All drag laws have the form of the papers, a coefficient beta per volume of bed (force per volume
beta * slip, slip between the particles, model A); one sphere's share is ``beta * volume / (1 - e)``.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from bedchain.dem.segments import read_parameters
from bedchain.dem.small_cases import Setup

GRAVITY = 9.81  # [m/s2], the project's


@dataclass(frozen=True)
class Suspension:
    """Equal spheres in a gas.

    Attributes
    ----------
    diameter, density : float
        Of the spheres [m], [kg/m3].
    gas_density, viscosity : float
        Of the gas [kg/m3], [Pa s].
    """

    diameter: float
    density: float
    gas_density: float
    viscosity: float

    @property
    def volume(self) -> float:
        """Of a sphere [m3]."""
        return float(np.pi / 6 * self.diameter**3)

    @property
    def mass(self) -> float:
        """Of a sphere [kg]."""
        return self.density * self.volume

    @property
    def weight(self) -> float:
        """Of a sphere, less its buoyancy [N]."""
        return (self.density - self.gas_density) * self.volume * GRAVITY

    def reynolds(self, slip: float) -> float:
        """Reynolds number of a slip [m/s] with the diameter [1]; never quite 0."""
        return max(self.gas_density * abs(slip) * self.diameter / self.viscosity, 1e-12)


Law = Callable[[Suspension, float, float], float]


def ergun_beta(of: Suspension, e: float, slip: float) -> float:
    """Ergun 1952, Chem. Eng. Prog. 48, 89, as in Gidaspow 1994, eq. (2.11) [kg/m3/s]."""
    viscous = 150 * (1 - e) ** 2 * of.viscosity / (e * of.diameter**2)
    return viscous + 1.75 * (1 - e) * of.gas_density * slip / of.diameter


def wen_yu_beta(of: Suspension, e: float, slip: float) -> float:
    """Wen, Yu 1966, with Schiller and Naumann's coefficient: Gidaspow 1994, eqs. (2.12)-(2.14) [kg/m3/s]."""
    re = of.reynolds(e * slip)
    coefficient = 24 / re * (1 + 0.15 * re**0.687) if re < 1000 else 0.44
    return 0.75 * coefficient * e * (1 - e) * of.gas_density * slip / of.diameter * e**-2.65


def gidaspow_beta(of: Suspension, e: float, slip: float) -> float:
    """Gidaspow 1994: Ergun below a voidage of 0.8, Wen-Yu above [kg/m3/s]."""
    return ergun_beta(of, e, slip) if e < 0.8 else wen_yu_beta(of, e, slip)


def gidaspow_blend_beta(of: Suspension, e: float, slip: float) -> float:
    """Lu, Gidaspow 2003, Chem. Eng. Sci. 58, 3777: the two weighted by an arc tangent about 0.8 [kg/m3/s]."""
    dilute = np.arctan(150 * 1.75 * (0.2 - (1 - e))) / np.pi + 0.5
    return float((1 - dilute) * ergun_beta(of, e, slip) + dilute * wen_yu_beta(of, e, slip))


def di_felice_beta(of: Suspension, e: float, slip: float) -> float:
    """Di Felice 1994, Int. J. Multiphase Flow 20, 153, eqs. (2), (14), (18) [kg/m3/s]."""
    re = of.reynolds(e * slip)
    exponent = 3.7 - 0.65 * np.exp(-((1.5 - np.log10(re)) ** 2) / 2)
    coefficient = (0.63 + 4.8 * re**-0.5) ** 2
    force = coefficient * np.pi / 8 * of.gas_density * of.diameter**2 * (e * slip) ** 2 * e**-exponent
    return float(force / slip * (1 - e) / of.volume)


def beetstra_beta(of: Suspension, e: float, slip: float) -> float:
    """Beetstra, van der Hoef, Kuipers 2007, AIChE J. 53, 489, eq. (16) [kg/m3/s]."""
    re, s = of.reynolds(e * slip), 1 - e
    low = 10 * s / e**2 + e**2 * (1 + 1.5 * s**0.5)
    share = (1 / e + 3 * e * s + 8.4 * re**-0.343) / (1 + 10 ** (3 * s) * re ** -((1 + 4 * s) / 2))
    factor = low + 0.413 * re / (24 * e**2) * share
    return 18 * of.viscosity * e * s * factor / of.diameter**2


def koch_hill_beta(of: Suspension, e: float, slip: float) -> float:
    """Hill, Koch, Ladd 2001 after Benyahia et al. 2006, Table 1; Re with the radius [kg/m3/s]."""
    s, re_radius = 1 - e, of.reynolds(e * slip) / 2
    if s < 0.4:
        upper = 1 + 3 * (s / 2) ** 0.5 + 135 / 64 * s * np.log(s) + 16.14 * s
        f0 = upper / (1 + 0.681 * s - 8.48 * s**2 + 8.16 * s**3)
    else:
        f0 = 10 * s / e**3
    f3 = 0.0673 + 0.212 * s + 0.0232 / e**5
    return float(18 * of.viscosity * e**2 * s * (f0 + f3 * re_radius) / of.diameter**2)


LAWS: dict[str, Law] = {
    "gidaspow": gidaspow_beta,
    "gidaspow_blend": gidaspow_blend_beta,
    "wen_yu": wen_yu_beta,
    "di_felice": di_felice_beta,
    "beetstra": beetstra_beta,
    "koch_hill": koch_hill_beta,
}


def drag_coefficient(law: Law, of: Suspension, e: float, slip: float) -> float:
    """Drag of one sphere over its slip [kg/s]; finite at rest."""
    slip = max(abs(slip), 1e-9)
    return law(of, e, slip) * of.volume / (1 - e)


def pressure_gradient(law: Law, of: Suspension, e: float, superficial: float) -> float:
    """Pressure drop over height of spheres held in a gas [Pa/m], model A: ``beta u / e``, ``u = U / e``."""
    return law(of, e, superficial / e) * superficial / e**2


def ergun_gradient(of: Suspension, e: float, superficial: float) -> float:
    """Ergun's pressure drop over height [Pa/m], in the form of Ergun 1952, eq. (11)."""
    viscous = 150 * (1 - e) ** 2 / e**3 * of.viscosity * superficial / of.diameter**2
    return viscous + 1.75 * (1 - e) / e**3 * of.gas_density * superficial**2 / of.diameter


def minimum_fluidization(of: Suspension, e: float) -> float:
    """Superficial velocity at which Ergun's pressure drop carries the bed [m/s]."""
    weight = (1 - e) * (of.density - of.gas_density) * GRAVITY
    return float(brentq(lambda speed: ergun_gradient(of, e, speed) - weight, 1e-9, 100))


def suspension(setup: Setup) -> Suspension:
    """Particles and gas of a case whose inputs are written; of parcels, the particles that they stand for."""
    parameters = read_parameters(setup.folder / "parameters.lig")
    names = ("particle_diameter", "density", "gas_density", "gas_viscosity")
    return Suspension(*(float(parameters[name]) for name in names))
