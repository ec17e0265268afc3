# SPDX-License-Identifier: GPL-3.0-or-later
"""Criteria for the physics that a scene needs, by dimensionless numbers, and whether the pipeline has it.

Each criterion compares a number with a threshold and its source, and keeps or drops one piece of physics. A
threshold holds by definition, is derived, published, or our choice; sources that were not checked say so.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import pandas as pd

from bedchain.physics import scene_numbers as numbers
from bedchain.physics.constants import GRAVITY_M_S2, PRESSURE_PA
from bedchain.physics.packing import wall_share
from bedchain.physics.scene_numbers import Scene

CROWE = "Crowe, Schwarzkopf, Sommerfeld, Tsuji 2012, Multiphase Flows with Droplets and Particles"
FLAT = "by definition: a grain's weight; an asperity before a flat (Israelachvili 2011, not verified)"
# Assumptions where the case has no key: dry glass or sand of usual roughness; numbers not verified
HAMAKER_J = 6.5e-20  # silica in air: Israelachvili 2011, Intermolecular and Surface Forces, Table 13.3
GAP_M = 4e-10  # of closest approach: Seville, Willett, Knight 2000, Powder Technol. 113, 261
ASPERITY_M = 1e-7  # radius of a grain's asperities: likewise
SURFACE_TENSION_N_M = 0.072  # water at 25 degrees Celsius
GLASS_YOUNG_PA, GLASS_POISSON = 7e10, 0.22  # of the real material: the case's contacts are softened
STRESS_RATIO = 0.5  # horizontal over vertical stress in a settled bed; 0.3 to 0.6 are usual


@dataclass(frozen=True)
class Criterion:
    """One piece of physics, its dimensionless number and threshold.

    Attributes
    ----------
    physics : str
        Kept or dropped by the number.
    number : str
        Name of the number.
    symbol : str
        Its formula.
    value, threshold : float
        The physics is kept where the value reaches the threshold [1].
    source : str
        Of the threshold.
    built : bool
        Whether the pipeline has it for this scene.
    of_gas : bool
        Whether it belongs to the gas and is dropped with it.
    """

    physics: str
    number: str
    symbol: str
    value: float
    threshold: float
    source: str
    built: bool
    of_gas: bool = False

    @property
    def needed(self) -> bool:
        """Whether the number reaches the threshold."""
        return self.value >= self.threshold


def audit(scene: Scene) -> pd.DataFrame:
    """Every criterion of a scene.

    Parameters
    ----------
    scene : Scene
        Of `bedchain.case.scene.scene_of`.

    Returns
    -------
    DataFrame
        physics, number, symbol, value, threshold, source, decision (keep, drop), built (yes, no),
        agrees (yes, no).
    """
    flow, *others = (
        *gas_criteria(scene),
        *force_criteria(scene),
        *contact_criteria(scene),
        *wall_criteria(scene),
    )
    rows = []
    for item in (flow, *others):
        keep = item.needed and (flow.needed or not item.of_gas)
        rows.append(
            {
                "physics": item.physics,
                "number": item.number,
                "symbol": item.symbol,
                "value": item.value,
                "threshold": item.threshold,
                "source": item.source,
                "decision": "keep" if keep else "drop",
                "built": "yes" if item.built else "no",
                "agrees": "yes" if keep == item.built else "no",
            }  # fmt: skip
        )
    return pd.DataFrame(rows)


def gas_criteria(scene: Scene) -> Iterator[Criterion]:
    """Gas flow as a whole (first), then properties of the gas."""
    single = numbers.single_drag(scene, math.sqrt(2 * GRAVITY_M_S2 * scene.fall)) / scene.weight
    carried = numbers.pressure_share(scene)
    yield Criterion(
        "gas flow", "drag over weight, forced or own", "max(dp_Ergun(U) A / W, F_d(sqrt(2 g h)) / w)",
        max(carried, single), 0.1,
        "our choice, a tenth of the weight; by definition 1 fluidizes, or is the terminal velocity",
        scene.gas,
    )  # fmt: skip
    yield Criterion(
        "bubbles", "Archimedes number", "Ar = rho_g (rho_p - rho_g) g d^3 / mu^2", numbers.archimedes(scene),
        88.5,
        "our choice, between Geldart's groups A and B, where sand of 0.1 mm in air has 94; Goossens 1998, "
        "Powder Technol. 98, 48, not verified", scene.gas, True,
    )  # fmt: skip
    ratio = scene.velocity / numbers.terminal_velocity(scene)
    yield Criterion(
        "particles leaving with the gas", "velocity over the terminal one", "U / u_t", ratio, 1.0,
        "by definition: the gas carries a single particle", False, True,
    )  # fmt: skip
    for name, speed in (
        ("u_mf (Ergun)", numbers.ergun_velocity(scene)),
        ("u_mf (Wen, Yu)", numbers.wen_yu_velocity(scene)),
        ("U", scene.velocity),
        ("u_t", numbers.terminal_velocity(scene)),
    ):
        yield Criterion(
            f"inertia of the gas in the drag law, at {name} = {speed:.4g} m/s", f"Reynolds number at {name}",
            "Re = rho_g u d / mu", numbers.reynolds(scene, speed), 0.2,
            "derived: 5 % above Stokes's law, by 0.15 Re^0.687 of Schiller, Naumann 1935", scene.gas, True,
        )  # fmt: skip
    yield from turbulence_criteria(scene)
    yield Criterion(
        "compressibility of the gas, by velocity", "Mach number", "max(U / e, u_t) / sqrt(gamma p / rho_g)",
        max(scene.velocity / scene.voidage, numbers.terminal_velocity(scene)) / numbers.sound_velocity(scene),
        0.3,
        "derived: 5 % of the density, (1 + (gamma - 1) M^2 / 2)^(1 / (gamma - 1))", False, True,
    )  # fmt: skip
    load = (1 - scene.voidage) * (scene.density - scene.gas_density) * GRAVITY_M_S2 * scene.depth
    yield Criterion(
        "compressibility of the gas, by pressure", "weight of the bed over the pressure", "W / (A p)",
        load * min(1, carried) / PRESSURE_PA, 0.05, "our choice, the same 5 %", False, True,
    )  # fmt: skip
    yield Criterion(
        "slip of the gas on particles", "Knudsen number", "Kn = lambda / d",
        numbers.free_path(scene) / scene.diameter,
        0.01, "derived: 2.5 % of the drag, 1 + 2.51 Kn (Davies 1945, Proc. Phys. Soc. 57, 259)", False, True,
    )  # fmt: skip


def turbulence_criteria(scene: Scene) -> Iterator[Criterion]:
    """Turbulence in the pores, between the walls of the slab, and of the size of the bed."""
    yield Criterion(
        "turbulence in the pores", "Reynolds number of the pores", "Re = rho_g (U / e) d / mu",
        numbers.reynolds(scene, scene.velocity / scene.voidage), 300,
        "unsteady and chaotic, with the size of the pores for d: Dybbs, Edwards 1984, in Fundamentals of "
        "Transport Phenomena in Porous Media, 199", False, True,
    )  # fmt: skip
    yield Criterion(
        "turbulence above the bed", "Reynolds number of the slab", "Re = rho_g U D_h / mu",
        scene.gas_density * scene.velocity * numbers.hydraulic_diameter(scene) / scene.viscosity, 2300,
        "transition in a pipe, by the hydraulic diameter: White 2011, Fluid Mechanics, ch. 6, not verified",
        False, True,
    )  # fmt: skip
    yield Criterion(
        "turbulence of the bed's size", "gas relaxation over the eddies' time", "tau_g U / W",
        numbers.gas_relaxation_time(scene) * scene.velocity / scene.width, 1.0,
        "by definition: drag stops an eddy that lives longer than the gas's relaxation time", False, True,
    )  # fmt: skip


def force_criteria(scene: Scene) -> Iterator[Criterion]:
    """Forces between gas and particles."""
    # A particle in a gas that speeds up over W keeps the slip St / (1 + St), so that its drag over the gas's
    # momentum is Z / (1 + St). Accelerated evenly for a relaxation time t, it has the history force
    # 3 d^2 sqrt(pi rho_g mu t) a, and Stokes's drag 3 pi mu d a t: sqrt(18 rho_g / (pi rho_p)) of it.
    density_ratio = scene.gas_density / scene.density
    stokes = scene.density * scene.diameter**2 * scene.velocity / (18 * scene.viscosity * scene.width)
    loading = (1 - scene.voidage) / (scene.voidage * density_ratio)
    yield Criterion(
        "slip between gas and particles", "Stokes number", "St = rho_p d^2 U / (18 mu W)", stokes, 0.1,
        "our choice, a tenth; at 1 they follow the gas half", scene.gas, True,
    )  # fmt: skip
    yield Criterion(
        "particles act on the gas", "momentum coupling", "Z / (1 + St), Z = (1 - e) rho_p / (e rho_g)",
        loading / (1 + stokes), 0.1, f"our choice, a tenth; derived as in {CROWE}, ch. 2", scene.gas, True,
    )  # fmt: skip
    yield Criterion(
        "force of the pressure gradient", "over the weight", "min(dp_Ergun(U), W) V_p / (h w)",
        (1 - scene.voidage) * min(1, numbers.pressure_share(scene)), 0.01,
        "our choice, a hundredth of the weight", scene.gas, True,
    )  # fmt: skip
    yield Criterion(
        "buoyancy in gas at rest", "gas to particle density", "rho_g / rho_p", density_ratio, 0.01,
        "our choice, a hundredth of the weight", False, True,
    )  # fmt: skip
    yield Criterion(
        "added mass", "added over own mass", "rho_g / (2 rho_p)", density_ratio / 2, 0.01,
        "our choice, a hundredth of the inertia; half of the displaced gas, as for any sphere", False, True,
    )  # fmt: skip
    yield Criterion(
        "history force", "Basset's force over Stokes's drag", "sqrt(18 rho_g / (pi rho_p))",
        math.sqrt(18 / math.pi * density_ratio), 0.1, "our choice, a tenth over a relaxation time; derived",
        False, True,
    )  # fmt: skip
    yield Criterion(
        "flow around each particle", "particle size over gas cell", "d / cell", scene.diameter / scene.cell,
        1 / 1.63,
        "our choice, cells of 1.63 d average; Peng et al. 2014, AIChE J. 60, 2000, not verified", False, True,
    )  # fmt: skip
    # A top hat of length L has the variance L^2/12, the hat kernel of half-width h the variance h^2/6
    widened = scene.smoothing / (math.sqrt(2) * scene.cell)
    yield Criterion(
        "kernel wider than the hat of one gas cell", "smoothing length over that of the cells",
        "L / (sqrt(2) cell)", widened, 1.0,
        "derived: variances L^2 / 12 and cell^2 / 6; below 1 gas.smoothing_diameters_1 does nothing",
        scene.gas and widened >= 1, True,
    )  # fmt: skip


def contact_criteria(scene: Scene) -> Iterator[Criterion]:
    """Collisions, cohesion and rolling."""
    yield Criterion(
        "collisions", "relaxation over collision time", "(u_t / g) n pi d^2 sqrt(g d)",
        numbers.relaxation_time(scene) / numbers.collision_time(scene), 1.0,
        f"by definition: dense above 1, as in {CROWE}, ch. 2", True,
    )  # fmt: skip
    yield Criterion(
        "drag within a collision", "contact over relaxation time", "t_c g / u_t",
        numbers.contact_duration(scene) / numbers.relaxation_time(scene), 0.1,
        "our choice: time scales ten times apart",
        False, True,
    )  # fmt: skip
    collision_stokes = scene.density * scene.diameter * numbers.grain_velocity(scene) / (9 * scene.viscosity)
    yield Criterion(
        "gas squeezed out of contacts", "loss of restitution",
        "1 - exp(-35 / St), St = rho_p d sqrt(g d) / (9 mu)",
        -math.expm1(-35 / collision_stokes), 0.1,
        "our choice, a tenth; Legendre, Daniel, Guiraud 2005, Phys. Fluids 17, 097105, not verified; St "
        "rules in gas too: Gondret, Lance, Petit 2002, Phys. Fluids 14, 643", False, True,
    )  # fmt: skip
    yield Criterion(
        "cohesion, van der Waals", "Bond number",
        "A r_a / (6 z^2 w): A = 6.5e-20 J, r_a = 0.1 um, z = 0.4 nm",
        HAMAKER_J * ASPERITY_M / (6 * GAP_M**2) / scene.weight, 1.0, FLAT, False,
    )  # fmt: skip
    yield Criterion(
        "cohesion, condensed water", "Bond number",
        "4 pi gamma r_a / w: gamma = 0.072 N/m, r_a = 0.1 um, no liquid added",
        4 * math.pi * SURFACE_TENSION_N_M * ASPERITY_M / scene.weight, 1.0,
        f"{FLAT}; bridges at asperities: Halsey, Levine 1998, Phys. Rev. Lett. 80, 3141", False,
    )  # fmt: skip
    yield Criterion(
        "rolling resistance", "contact over particle radius", "a_Hertz / R under the settled bed, of glass",
        contact_radius(scene) / (scene.diameter / 2), 0.05,
        "our choice; no arm is longer than a (Johnson 1985, Contact Mechanics, ch. 9); larger ones "
        "shape heaps: Zhou, Xu, Yu, Zulli 2001, Phys. Rev. E 64, 021301", scene.rolling > 0,
    )  # fmt: skip


def contact_radius(scene: Scene) -> float:
    """Radius of a real contact under the bed's weight on one particle [m] (Hertz: Johnson 1985, ch. 4)."""
    load = (1 - scene.voidage) * scene.density * GRAVITY_M_S2 * scene.depth * scene.diameter**2
    modulus = GLASS_YOUNG_PA / (2 * (1 - GLASS_POISSON**2))
    return (3 * load * scene.diameter / 4 / (4 * modulus)) ** (1 / 3)


def wall_criteria(scene: Scene) -> Iterator[Criterion]:
    """Friction on walls, and the third dimension."""
    # Walls that hold the particles count at rest, as the side walls do; one layer has none, and real ones
    # would bear only what the gas does not carry
    resting = 1 if scene.layered else 1 - min(1, numbers.pressure_share(scene))
    janssen = 2 * scene.friction * STRESS_RATIO * scene.depth
    # Janssen 1895: dp / dz = rho g - 2 mu K p / W, so that the floor carries (1 - exp(-j)) / j of the weight
    source = "our choice, a hundredth of the weight; derived as by Janssen 1895"
    yield Criterion(
        "friction on the side walls", "Janssen's share of the weight",
        "1 - (1 - exp(-j)) / j, j = 2 mu K h / W, at rest",
        wall_share(janssen / scene.width), 0.01, source, True,
    )  # fmt: skip
    yield Criterion(
        "friction in front and behind", "Janssen's share of the weight",
        "the same with T; for one layer, of what the gas does not carry",
        resting * wall_share(janssen / scene.thickness), 0.01, source, scene.layered,
    )  # fmt: skip
    yield Criterion(
        "third dimension", "thickness over diameter", "T / d", scene.thickness / scene.diameter, 2.0,
        "by definition: below 2 no particle passes another in depth", scene.layered,
    )  # fmt: skip
