# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of particles and gas at extremes, for the real solvers on tiny beds."""

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

from bedchain.case.bed_checks import OVERLAP_AT_REST_MAX, RAYLEIGH_SHARE_MAX
from bedchain.case.gas_checks import GAS_CELL_MAX
from bedchain.physics.packing import START_SPACING_DIAMETERS, settled_height
from bedchain.physics.scene_numbers import contact_duration, grain_velocity, terminal_velocity
from bedchain.studies.stability import theory
from bedchain.studies.stability.bed_runs import GAS_SHARE, Expected, run_bed
from bedchain.studies.stability.beds import (
    DENSITY,
    DIAMETER,
    GAS_DENSITY,
    StabilityBed,
    case_of,
    clock,
    scene,
    two_digits,
)
from bedchain.studies.stability.collisions import Collision, run_collision
from bedchain.studies.stability.settings import ON, Known, StabilitySetting
from bedchain.studies.stability.theory import Limit
from bedchain.studies.stability.verdict import Verdict

STIFFNESSES = (1e4, 1e5, 1e6, 1e7, 1e8, 1e9)  # [Pa]
SHARES = (0.01, 0.05, 0.2, 0.5, 1.0, 1.5)  # of the Rayleigh time
COLLISION_SHARES = (0.01, 0.1, 0.5, 1.0, 1.5)  # of the duration of a collision
GAS_STEPS = (1e-5, 1e-4, 1e-3, 1e-2)  # [s]
DIAMETERS = (5e-5, 5e-4, 1e-3, 5e-3)  # [m]
RATIOS = (1.0, 2.0, 10.0, 100.0, 1e3, 1e4)  # of the particles' to the gas's density
CELLS = (1, 2, 4, 5, 10, 20)  # diameters
SMALL = StabilityBed(number=64, width=8, height=40, cell=2, settle=0.1, run=0.03)  # where steps are short
FIXED, FLUIDIZED = 0.7, 2.0  # of the velocity of minimum fluidization
UNSTABLE = 1.5  # Rayleigh times
STEP_GUARD = "time.allow_unstable_step: true"
FINEST_CELL = 1.63  # diameters: Peng, Doroodchi, Luo, Moghtaderi 2014, AIChE J. 60, 2000
THINNEST = 0.8165  # diameters, of a slab
DEEP = StabilityBed(number=1500, height=140, settle=0.4)  # 72 diameters: higher than all gas cells
ANEW = 0.15  # likewise, where the bed has settled in another way
CELL_SHARE = 0.2  # relative, of the weight on the gas with cells of another size


def setting_of(
    group: str,
    name: str,
    bed: StabilityBed,
    limit: Limit,
    expected: Expected,
    guards: str = ON,
    reduced: bool = False,
) -> StabilitySetting:
    """Setting of a bed."""
    time = clock(bed)
    values: dict[str, float | str] = {
        "diameter_m": bed.diameter, "density_kg_m3": bed.density, "number_1": bed.number,
        "young_Pa": bed.stiffness, "dem_step_s": time["dem_step_s"], "gas_step_s": time["gas_step_s"],
        "velocity_m_s": bed.velocity, "gas_cell_m": bed.cell * bed.diameter, "ranks_1": bed.ranks,
    }  # fmt: skip
    inputs = repr((case_of(bed), expected))
    run = partial(_run, bed, expected)
    return StabilitySetting(group, name, values, limit, run, inputs, guards, expected.reference, reduced)


def _run(bed: StabilityBed, expected: Expected, folder: Path, known: Known) -> Verdict:
    return run_bed(folder, bed, expected, known)


def bed_settings() -> list[StabilitySetting]:
    """All settings of particles and gas, group by group."""
    groups = (dem_step, collision_time, gas_step, density, velocity, packing, gas_cell, ranks, guards)
    return [setting for group in groups for setting in group()]


def unstable_twice(
    group: str, name: str, bed: StabilityBed, limit: Limit, reference: str
) -> Iterator[StabilitySetting]:
    """A step with its guard on and, where the guard refuses it, with the guard off."""
    small = scene(bed)
    expected = Expected(overlap=theory.deepest_overlap(small, bed.number), reference=reference)
    reduced = bed.stiffness == STIFFNESSES[1] and "150 %" in name
    refused = clock(bed)["dem_step_s"] > RAYLEIGH_SHARE_MAX * theory.rayleigh(small)
    yield setting_of(group, name, bed, limit, expected, reduced=reduced)
    if refused:
        allowed = replace(bed, allowed=True)
        yield setting_of(group, f"{name}, guard off", allowed, limit, expected, STEP_GUARD, reduced)


def dem_step() -> Iterator[StabilitySetting]:
    """Particles' step over the Rayleigh time, by stiffness; a bed at rest without gas flow."""
    plain = replace(SMALL, young=1e6)
    reference = "bed at rest"
    deepest = theory.deepest_overlap(scene(plain), plain.number)
    limit = theory.dem_step_limit(scene(plain), clock(plain)["dem_step_s"])
    yield setting_of("dem_step", reference, plain, limit, Expected(overlap=deepest), reduced=True)
    for young in STIFFNESSES:
        for share in SHARES:
            stiff = replace(SMALL, young=young)
            bed = replace(stiff, dem_step=two_digits(share * theory.rayleigh(scene(stiff))))
            limit = theory.dem_step_limit(scene(bed), clock(bed)["dem_step_s"])
            name = f"E {young:.0e} Pa, step {100 * share:g} % of the Rayleigh time"
            yield from unstable_twice("dem_step", name, bed, limit, reference)


def collision_time() -> Iterator[StabilitySetting]:
    """Particles' step over the duration of a collision, by stiffness; pairs of spheres without gas."""
    for young in STIFFNESSES:
        stiff = scene(replace(SMALL, young=young))
        duration = contact_duration(stiff)
        for share in COLLISION_SHARES:
            step = two_digits(share * duration)
            collision = Collision(young, step, grain_velocity(stiff), duration)
            name = f"E {young:.0e} Pa, step {100 * share:g} % of a collision"
            reduced = young == STIFFNESSES[2] and share in (COLLISION_SHARES[0], 1)
            limit = theory.collision_limit(stiff, step)
            yield of_collision(name, collision, limit, ON, reduced)
            if step > RAYLEIGH_SHARE_MAX * theory.rayleigh(stiff):
                allowed = replace(collision, allowed=True)
                yield of_collision(f"{name}, guard off", allowed, limit, STEP_GUARD, reduced)


def of_collision(
    name: str, collision: Collision, limit: Limit, guards: str, reduced: bool
) -> StabilitySetting:
    """Setting of a collision."""
    values: dict[str, float | str] = {
        "diameter_m": DIAMETER, "density_kg_m3": DENSITY, "young_Pa": collision.young,
        "dem_step_s": collision.step,
    }  # fmt: skip
    run = partial(_run_collision, collision)
    return StabilitySetting("collision_time", name, values, limit, run, repr(collision), guards, "", reduced)


def _run_collision(collision: Collision, folder: Path, known: Known) -> Verdict:
    return run_collision(folder, collision)


def gas_step() -> Iterator[StabilitySetting]:
    """Step of the gas, by the size of the particles: below and above the velocity of fluidization."""
    for diameter in DIAMETERS:
        for share in (FIXED, FLUIDIZED):
            plain = StabilityBed(diameter=diameter, run=0.12)
            plain = replace(plain, velocity=share * theory.fluidization(scene(plain)))
            usual = f"d {1e3 * diameter:g} mm, {share:g} u_mf, usual gas step"
            moving = share > 1
            yield setting_of("gas_step", usual, plain, _gas_limit(plain), Expected(moving=moving))
            for step in GAS_STEPS:
                bed = replace(plain, gas_step=step)
                name = f"d {1e3 * diameter:g} mm, {share:g} u_mf, gas step {step:g} s"
                # another step of the particles lets them settle in another way, and the gas feels it
                anew = clock(bed)["dem_step_s"] != clock(plain)["dem_step_s"]
                expected = Expected(moving, reference=usual, share_tolerance=ANEW if anew else GAS_SHARE)
                reduced = diameter == DIAMETERS[2] and not moving and step == GAS_STEPS[-1]
                yield setting_of("gas_step", name, bed, _gas_limit(bed), expected, reduced=reduced)


def _gas_limit(bed: StabilityBed) -> Limit:
    return theory.gas_step_limit(scene(bed), clock(bed)["gas_step_s"])


def density() -> Iterator[StabilitySetting]:
    """Density of the particles over that of the gas, fluidized."""
    for ratio in RATIOS:
        bed = StabilityBed(density=ratio * GAS_DENSITY, run=0.12)
        speed = 0.01 if ratio <= 1 else FLUIDIZED * theory.fluidization(scene(bed))
        bed = replace(bed, velocity=speed)
        name = f"density ratio {ratio:g}"
        yield setting_of("density", name, bed, theory.density_limit(1 / ratio), Expected(moving=True))


def velocity() -> Iterator[StabilitySetting]:
    """Superficial velocity, from 0 up to one that carries the bed out through the top."""
    plain = StabilityBed(height=200, run=0.2)
    least = theory.fluidization(scene(plain))
    for name, speed, moving in (
        ("no gas flow", 0.0, False),
        ("u_mf", least, True),
        ("2.7 u_mf", 2.7 * least, True),
        ("u_t", terminal_velocity(scene(plain)), True),
        ("10 u_mf", 10 * least, True),
    ):
        bed = replace(plain, velocity=speed, gas_step=1e-4 if moving else None)
        yield setting_of(
            "velocity", name, bed, theory.velocity_limit(scene(bed)), Expected(moving=moving),
            reduced=speed == 0,
        )  # fmt: skip


def packing() -> Iterator[StabilitySetting]:
    """Number of particles and thickness of the slab: at the limit and beyond, a single particle, none."""
    plain = StabilityBed()
    lattice = plain.width / int(plain.width / START_SPACING_DIAMETERS)
    most = int(plain.width / START_SPACING_DIAMETERS) * int(plain.height / lattice)

    def full(number: int) -> Limit:
        return Limit("particles [1]", most, "sites of the lattice of 1.15 d that they fall from", number)

    for number in (most, most + 1):
        yield setting_of(
            "packing", f"{number} particles", StabilityBed(number=number), full(number), Expected()
        )
    for thickness in (THINNEST, 0.8):
        bed = StabilityBed(thickness=thickness)
        bed = replace(bed, velocity=FIXED * theory.fluidization(scene(bed)))
        yield setting_of("packing", f"slab of {thickness:g} d", bed, _thin_limit(thickness), Expected())
    single = StabilityBed(number=1)
    rolling = Expected(moving=True, height_m=single.diameter / 2)  # it rolls from wall to wall
    yield setting_of("packing", "one particle", single, full(1), rolling, reduced=True)
    blown = replace(single, velocity=1.5 * terminal_velocity(scene(single)), gas_step=1e-4, run=0.3)
    limit = theory.velocity_limit(scene(blown))
    yield setting_of("packing", "one particle at 1.5 u_t", blown, limit, Expected(moving=True), reduced=True)
    yield setting_of("packing", "no particle", StabilityBed(number=0), full(0), Expected(), reduced=True)


def _thin_limit(thickness: float) -> Limit:
    return Limit("d over thickness [1]", math.sqrt(1.5), "T >= sqrt(2/3) d", 1 / thickness)


def gas_cell() -> Iterator[StabilitySetting]:
    """Size of a gas cell, in a deep and a shallow fixed bed: the gas must carry the same weight."""
    for name, plain, cells in (("deep", DEEP, CELLS), ("shallow", StabilityBed(), CELLS[2:])):
        plain = replace(plain, velocity=FIXED * theory.fluidization(scene(plain)))
        usual = f"{name} bed, usual gas cells"
        yield setting_of("gas_cell", usual, plain, _cell_limit(plain), Expected())
        expected = Expected(reference=usual, share_tolerance=CELL_SHARE)
        for cell in cells:
            bed = replace(plain, cell=cell)
            yield setting_of(
                "gas_cell", f"{name} bed, gas cells of {cell} d", bed, _cell_limit(bed), expected
            )


def _cell_limit(bed: StabilityBed) -> Limit:
    if bed.cell < FINEST_CELL:
        formula = "d / cell <= 1 / 1.63 (Peng et al. 2014)"
        return Limit("diameter over gas cell [1]", 1 / FINEST_CELL, formula, 1 / bed.cell)
    height = settled_height(bed.number, 1.0, bed.width)
    return Limit("gas cell [d]", GAS_CELL_MAX * height, "half of the settled height", bed.cell)


def ranks() -> Iterator[StabilitySetting]:
    """The same bed on one, two and four ranks."""
    plain = StabilityBed()
    plain = replace(plain, velocity=FIXED * theory.fluidization(scene(plain)))
    for number in (1, 2, 4):
        limit = Limit("ranks [1]", plain.width / plain.cell, "gas cells / ranks whole", number)
        # on other ranks the particles settle in another way
        expected = Expected(reference="" if number == 1 else "1 rank", share_tolerance=ANEW)
        name = f"{number} rank{'s' * (number > 1)}"
        yield setting_of("ranks", name, replace(plain, ranks=number), limit, expected, reduced=number == 4)


def guards() -> Iterator[StabilitySetting]:
    """Settings with a guard on and off."""
    soft = StabilityBed(thickness=THINNEST)
    share = theory.overlap_at_rest(scene(soft), soft.number)
    soft = replace(soft, young=soft.stiffness * (share / (0.95 * OVERLAP_AT_REST_MAX)) ** 1.5)
    soft = replace(soft, velocity=FIXED * theory.fluidization(scene(soft)))
    counted = replace(soft, more={"gas": {"voidage_clip": "count"}})
    for bed, guard in ((soft, ON), (counted, "gas.voidage_clip: count")):
        name = f"soft bed in a thin slab{'' if guard == ON else ', guard off'}"
        yield setting_of("guards", name, bed, _thin_limit(THINNEST), Expected(), guard)
    long = StabilityBed(allowed=True)
    long = replace(long, dem_step=two_digits(UNSTABLE * theory.rayleigh(scene(long))))
    limit = theory.dem_step_limit(scene(long), clock(long)["dem_step_s"])
    blind = replace(long, more={"contact": {"largest_overlap_1": 1.0}})
    expected = Expected(overlap=theory.deepest_overlap(scene(long), long.number))
    for bed, guard in ((long, ON), (blind, "contact.largest_overlap_1: 1")):
        name = f"step of {UNSTABLE:g} Rayleigh times{'' if guard == ON else ', guard off'}"
        yield setting_of("guards", name, bed, limit, expected, guard, True)
