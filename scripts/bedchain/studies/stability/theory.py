# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits by theory, with which the settings are compared."""

import math
from dataclasses import dataclass

from bedchain.case.bed_checks import RAYLEIGH_SHARE_MAX
from bedchain.case.gas_checks import ADDED_MASS_MAX, COURANT_MAX, FREE_FALL_SHARE_MAX
from bedchain.physics.constants import GRAVITY_M_S2
from bedchain.physics.contacts import contact_modulus, rayleigh_time, static_overlap
from bedchain.physics.fluidization import DENSE_VOIDAGE
from bedchain.physics.scene_numbers import (
    Scene,
    contact_duration,
    ergun_velocity,
    grain_velocity,
    terminal_velocity,
)

OVERLAP_TIMES = 3.0  # of the overlap under even loads: force chains carry some times as much
LATTICE_STIFFNESS = 6.0  # m omega^2 / k of the stiffest wave in closest discs joined by springs k


@dataclass(frozen=True)
class Limit:
    """A limit by theory.

    Attributes
    ----------
    quantity : str
        Quantity that it limits, with its unit in brackets.
    value : float
        The limit.
    formula : str
    at : float
        Value of the quantity in the setting.
    """

    quantity: str
    value: float
    formula: str
    at: float

    @property
    def share(self) -> float:
        """Value in the setting over the limit [1]."""
        return self.at / self.value if self.value else math.inf


def rayleigh(scene: Scene) -> float:
    """Time of a surface wave over a particle [s] (`contacts.rayleigh_time`)."""
    return rayleigh_time(scene.young, scene.poisson, scene.density, scene.diameter / 2)


def overlap_at_rest(scene: Scene, number: int) -> float:
    """Overlap under the weight of the whole settled bed over the diameter [1]."""
    return static_overlap(
        scene.young, scene.poisson, scene.density, scene.diameter, number, scene.width, scene.thickness
    )


def deepest_overlap(scene: Scene, number: int) -> float:
    """Overlap over the diameter that no contact of a bed coming to rest should exceed [1].

    The larger of `OVERLAP_TIMES` the overlap at rest and that of a particle after a fall over a diameter,
    ``(15 m* v^2 / (16 E* sqrt(R*)))^(2/5) / d`` (Hertz; Johnson 1985, Contact Mechanics, ch. 11).
    """
    mass, modulus = scene.density * scene.volume / 2, contact_modulus(scene.young, scene.poisson)
    energy = 15 * mass * grain_velocity(scene) ** 2 / (16 * modulus * math.sqrt(scene.diameter / 4))
    return max(OVERLAP_TIMES * overlap_at_rest(scene, number), energy**0.4 / scene.diameter)


def oscillator_step(scene: Scene, number: int) -> float:
    """Longest stable step of central differences in the settled bed [s]: ``2 / omega``.

    ``omega^2 = 6 k / m``, the stiffest wave in closest discs, with Hertz's tangent stiffness
    ``k = 2 E* sqrt(R* delta)`` at the overlap of the bottom layer. The bound omega dt < 2 is that of any
    linear oscillator (O'Sullivan, Bray 2004, Eng. Comput. 21, 278).

    Parameters
    ----------
    scene : Scene
    number : int
        Particles.
    """
    overlap = overlap_at_rest(scene, number) * scene.diameter
    stiffness = 2 * contact_modulus(scene.young, scene.poisson) * math.sqrt(scene.diameter / 4 * overlap)
    return 2 / math.sqrt(LATTICE_STIFFNESS * stiffness / (scene.density * scene.volume))


def dem_step_limit(scene: Scene, step: float) -> Limit:
    """Limit of the particles' step, a share of the Rayleigh time."""
    formula = f"{RAYLEIGH_SHARE_MAX:g} pi r sqrt(rho/G) / (0.1631 nu + 0.8766)"
    return Limit("DEM step [s]", RAYLEIGH_SHARE_MAX * rayleigh(scene), formula, step)


def collision_limit(scene: Scene, step: float) -> Limit:
    """Limit of the particles' step: duration of an elastic collision after a fall over one diameter."""
    formula = "2.868 (m*^2 / (R* E*^2 sqrt(g d)))^(1/5)"
    return Limit("DEM step [s]", contact_duration(scene), formula, step)


def courant_limit(scene: Scene, step: float) -> Limit:
    """Limit of the gas step: the time in which the gas of a packed bed crosses one cell."""
    speed = scene.velocity / DENSE_VOIDAGE
    value = COURANT_MAX * scene.cell / speed if speed else math.inf
    return Limit("gas step [s]", value, "cell / (U / 0.4)", step)


def free_fall_limit(scene: Scene, step: float) -> Limit:
    """Limit of the gas step: a share of the time in which a particle falls through one gas cell."""
    value = FREE_FALL_SHARE_MAX * math.sqrt(2 * scene.cell / GRAVITY_M_S2)
    return Limit("gas step [s]", value, f"{FREE_FALL_SHARE_MAX:g} sqrt(2 cell / g)", step)


def gas_step_limit(scene: Scene, step: float) -> Limit:
    """The stricter of the two limits of the gas step."""
    return min(courant_limit(scene, step), free_fall_limit(scene, step), key=lambda limit: limit.value)


def density_limit(ratio: float) -> Limit:
    """Limit of gas over particle density: above it the added mass matters, which the equations lack."""
    return Limit("gas over particle density [1]", 2 * ADDED_MASS_MAX, "rho_g / (2 rho_p) <= 0.05", ratio)


def velocity_limit(scene: Scene) -> Limit:
    """Limit of the superficial velocity: the terminal velocity of a particle."""
    formula = "F_d(u_t) = (rho_p - rho_g) V g, Schiller and Naumann"
    return Limit("superficial velocity [m/s]", terminal_velocity(scene), formula, scene.velocity)


def fluidization(scene: Scene) -> float:
    """Velocity of minimum fluidization [m/s]."""
    return ergun_velocity(scene)
