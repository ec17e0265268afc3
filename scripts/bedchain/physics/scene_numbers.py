# SPDX-License-Identifier: GPL-3.0-or-later
"""Velocities, forces and times of a scene, from the numbers of its case: the basis of the audit."""

import math
from dataclasses import dataclass

from bedchain.physics import fluidization
from bedchain.physics.constants import ADIABATIC_INDEX, GRAVITY_M_S2, PRESSURE_PA
from bedchain.physics.contacts import contact_modulus

NEWTON_REYNOLDS, NEWTON_COEFFICIENT = 1000.0, 0.44  # end of Schiller and Naumann's range, drag beyond
VELOCITY_RANGE_M_S = (1e-12, 1e4)  # bracket of a terminal velocity
HERTZ_DURATION = 2.868  # of a collision of elastic spheres: Johnson 1985, Contact Mechanics, eq. (11.24)


@dataclass(frozen=True)
class Scene:
    """The numbers of a case that decide which physics it needs.

    Attributes
    ----------
    diameter, density : float
        Of the particles [m], [kg/m3].
    gas_density, viscosity, velocity : float
        Of the gas [kg/m3], [Pa s], superficial velocity [m/s]; 0 where the gas is not simulated.
    width, thickness, depth, fall : float
        Width of the bed, thickness of the slab, depth of the settled particles, largest height of fall [m].
    voidage : float
        Of the settled bed [1], with the volume of the slab.
    young, poisson, friction, rolling : float
        Of the contacts in the simulation [Pa], [1]; sliding and rolling friction.
    cell : float
        Edge of a gas cell [m].
    smoothing : float
        Length over which the voidage is smoothed [m].
    gas : bool
        Whether the gas is simulated.
    layered : bool
        Whether particles also move along y, between a front and a back wall.
    """

    diameter: float
    density: float
    gas_density: float
    viscosity: float
    velocity: float
    width: float
    thickness: float
    depth: float
    fall: float
    voidage: float
    young: float
    poisson: float
    friction: float
    rolling: float
    cell: float
    smoothing: float
    gas: bool
    layered: bool

    @property
    def volume(self) -> float:
        """Volume of a particle [m3]."""
        return math.pi / 6 * self.diameter**3

    @property
    def weight(self) -> float:
        """Weight of a particle less its buoyancy [N]."""
        return (self.density - self.gas_density) * self.volume * GRAVITY_M_S2


def archimedes(scene: Scene) -> float:
    """Archimedes number [1], ``rho_g (rho_p - rho_g) g d^3 / mu^2``."""
    difference = scene.density - scene.gas_density
    return scene.gas_density * difference * GRAVITY_M_S2 * scene.diameter**3 / scene.viscosity**2


def reynolds(scene: Scene, velocity: float) -> float:
    """Reynolds number of a velocity [m/s] and the particle diameter [1]."""
    return scene.gas_density * velocity * scene.diameter / scene.viscosity


def ergun_velocity(scene: Scene) -> float:
    """Superficial velocity at which the gas carries the settled bed [m/s], by Ergun 1952."""
    return fluidization.ergun_velocity(
        scene.voidage, scene.diameter, scene.density, scene.gas_density, scene.viscosity
    )


def ergun_gradient(scene: Scene, velocity: float) -> float:
    """Pressure gradient of the settled bed at a superficial velocity [m/s], by Ergun 1952 [Pa/m]."""
    return fluidization.ergun_gradient(
        scene.voidage, scene.diameter, scene.gas_density, scene.viscosity, velocity
    )


def wen_yu_velocity(scene: Scene) -> float:
    """Minimum fluidization velocity by Wen, Yu 1966, AIChE J. 12, 610 [m/s], without a voidage."""
    root = math.sqrt(33.7**2 + 0.0408 * archimedes(scene)) - 33.7
    return root * scene.viscosity / (scene.gas_density * scene.diameter)


def pressure_share(scene: Scene) -> float:
    """Pressure drop of the settled bed by Ergun over its weight per area [1]; 1 fluidizes it."""
    weight = (1 - scene.voidage) / scene.volume * scene.weight
    return ergun_gradient(scene, scene.velocity) / weight


def single_drag(scene: Scene, velocity: float) -> float:
    """Drag of one sphere in still gas [N], with Schiller and Naumann's coefficient (1935)."""
    re = reynolds(scene, velocity)
    if re < NEWTON_REYNOLDS:
        return 3 * math.pi * scene.viscosity * scene.diameter * velocity * (1 + 0.15 * re**0.687)
    return NEWTON_COEFFICIENT * math.pi / 8 * scene.gas_density * scene.diameter**2 * velocity**2


def terminal_velocity(scene: Scene) -> float:
    """Velocity at which one sphere falls through still gas [m/s]."""
    from scipy.optimize import brentq  # late: scipy.optimize takes half a second to load

    return float(
        brentq(lambda speed: single_drag(scene, speed) - scene.weight, *VELOCITY_RANGE_M_S, rtol=1e-12)
    )


def relaxation_time(scene: Scene) -> float:
    """Relaxation time of a particle's velocity to the gas's, at the terminal velocity [s], ``u_t / g``."""
    return terminal_velocity(scene) / GRAVITY_M_S2


def gas_relaxation_time(scene: Scene) -> float:
    """Relaxation time of the gas in the settled bed [s]: ``rho_g U`` over Ergun's pressure gradient.

    U is at least the velocity of minimum fluidization, as in the dense phase of a bubbling bed.
    """
    speed = max(scene.velocity, ergun_velocity(scene))
    return scene.gas_density * speed / ergun_gradient(scene, speed)


def grain_velocity(scene: Scene) -> float:
    """Relative velocity of neighbours in a dense bed [m/s], ``sqrt(g d)``: a fall over half a diameter."""
    return math.sqrt(GRAVITY_M_S2 * scene.diameter)


def collision_time(scene: Scene) -> float:
    """Time between two collisions of a particle in the settled bed [s], ``1 / (n pi d^2 v)``."""
    number_density = (1 - scene.voidage) / scene.volume
    return 1 / (number_density * math.pi * scene.diameter**2 * grain_velocity(scene))


def contact_duration(scene: Scene) -> float:
    """Duration of an elastic collision of two particles at `grain_velocity` [s] (Hertz; Johnson 1985)."""
    modulus = contact_modulus(scene.young, scene.poisson)
    mass, radius = scene.density * scene.volume / 2, scene.diameter / 4
    return HERTZ_DURATION * (mass**2 / (radius * modulus**2 * grain_velocity(scene))) ** 0.2


def sound_velocity(scene: Scene) -> float:
    """Velocity of sound in the gas [m/s], ``sqrt(gamma p / rho)``."""
    return math.sqrt(ADIABATIC_INDEX * PRESSURE_PA / scene.gas_density)


def free_path(scene: Scene) -> float:
    """Mean free path of the gas [m], ``mu sqrt(pi / (2 rho p))``."""
    return scene.viscosity * math.sqrt(math.pi / (2 * scene.gas_density * PRESSURE_PA))


def hydraulic_diameter(scene: Scene) -> float:
    """Hydraulic diameter of the slab's cross section [m], ``2 W T / (W + T)``."""
    return 2 * scene.width * scene.thickness / (scene.width + scene.thickness)
