# SPDX-License-Identifier: GPL-3.0-or-later
"""Pressure of a granular gas by kinetic theory (Lun et al. 1984, J. Fluid Mech. 140, 223), as in OpenFOAM."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
FRICTION_FROM = 0.5  # share of the solids from which friction takes over: the contact value grows no more
LEAST = 1e-3  # share of the solids, for the slope of the contact value


class Granular(NamedTuple):
    """Solids of a two-fluid bed.

    Attributes
    ----------
    density_kg_m3 : float
        Of a particle.
    restitution_1 : float
    largest_solids : float
        Share at which they are packed [1].
    """

    density_kg_m3: float
    restitution_1: float
    largest_solids: float

    def _cube_root(self, solids: Array) -> Array:
        return np.asarray(np.cbrt(np.clip(solids, LEAST, FRICTION_FROM) / self.largest_solids))

    def contact_value(self, solids: Array) -> Array:
        """Radial distribution at contact g0 [1] (Sinclair and Jackson 1989, AIChE J. 35, 1473)."""
        return 1 / (1 - self._cube_root(solids))

    def pressure_over_temperature(self, solids: Array) -> Array:
        """Granular pressure over the granular temperature, rho a (1 + 2 (1 + e) a g0) [kg/m3]."""
        collisions = 2 * (1 + self.restitution_1) * solids * self.contact_value(solids)
        return np.asarray(self.density_kg_m3 * solids * (1 + collisions))

    def pressure_slope(self, solids: Array) -> Array:
        """Derivative of `pressure_over_temperature` with respect to the share of the solids [kg/m3]."""
        root, value = self._cube_root(solids), self.contact_value(solids)
        steepness = value**2 / (3 * self.largest_solids * root**2)
        collisions = (1 + self.restitution_1) * solids * (4 * value + 2 * steepness * solids)
        return np.asarray(self.density_kg_m3 * (1 + collisions))
