# SPDX-License-Identifier: GPL-3.0-or-later
"""What a case without gas uses and may hold, the drum, and limits that `study_stability` found.

`case_checks` has the other checks.
"""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from bedchain.case.checks import Finding, reads
from bedchain.physics.constants import GRAVITY_M_S2
from bedchain.physics.contacts import static_overlap
from bedchain.physics.packing import START_SPACING_DIAMETERS, settled_height
from bedchain.physics.whole_numbers import is_multiple, nearest_multiple, rounded_down

READ_WITHOUT_GAS = ("model", "density_kg_m3", "viscosity_Pa_s")  # by the audit
# of the diameter: the lowest layer of the paper's bed has 0.06; where it is 0.095 a bed sags by 16 %
OVERLAP_AT_REST_MAX = 0.09
ADDED_MASS_MAX = 0.05  # of a particle's own mass: no equation here has the gas that it takes along
FREE_FALL_SHARE_MAX = 0.1  # of the time to fall through a gas cell: at 0.14 a fixed bed of 0.05 mm rattled
GAS_CELL_MAX = 0.5  # of the settled height: where a cell is higher than the bed the gas carries a third
LAYERS_MIN = 10  # fewer are hardly a bed: its top and bottom are all there is of it
UNUSED_WITHOUT_GAS = {"time": ("gas_step_s", "ramp_s"), "contact": ("largest_overlap_1",)}  # bedFoam's


def used_keys(case: dict[str, Any]) -> dict[str, Any]:
    """The case without the keys that its scene does not use: without gas, those of gas and its steps.

    Parameters
    ----------
    case : dict
        The case with its defaults; sections that the schema refused may be of any kind.
    """
    gas = case.get("gas")
    if not isinstance(gas, dict) or gas.get("model") != "none":
        return case
    used = case | {"gas": {key: value for key, value in gas.items() if key in READ_WITHOUT_GAS}}
    for section, unused in UNUSED_WITHOUT_GAS.items():
        if isinstance(keys := case.get(section), dict):
            used[section] = {key: value for key, value in keys.items() if key not in unused}
    return used


def checked_keys(case: dict[str, Any]) -> dict[str, Any]:
    """`used_keys`, and ``scene``: ``box, coupled`` or ``drum, none``, or two that cannot be."""
    gas = case.get("gas")
    model = gas.get("model") if isinstance(gas, dict) else None
    return used_keys(case) | {"scene": f"{'drum' if 'drum' in case else 'box'}, {model}"}


def drum_sites(diameter: float, particle: float) -> int:
    """Sites of the loose lattice inside a drum that its particles fall from [1], as ``drum/in.fill``.

    Parameters
    ----------
    diameter, particle : float
        Of the drum and of a particle [m].
    """
    spacing = START_SPACING_DIAMETERS * particle
    along = (np.arange(int(diameter / spacing) + 1) + 0.5) * spacing - diameter / 2
    return int(np.count_nonzero(np.hypot(*np.meshgrid(along, along)) <= (diameter - particle) / 2))


@reads("time.dem_step_s", "time.gas_step_s", "time.frame_interval_s", "time.ramp_s", "time.end_s")
def gas_steps_nest(dem: float, gas: float, frame: float, ramp: float, end: float) -> Iterator[Finding]:
    """Refuse steps of the gas that do not fit the particles' or the frames, and a ramp that never ends."""
    pairs = [("gas_step_s", gas, "dem_step_s", dem), ("frame_interval_s", frame, "gas_step_s", gas)]
    for name, length, unit_name, unit in pairs:
        if not is_multiple(length, unit):
            wrong = f"{length:g} s is no multiple of time.{unit_name} ({unit:g} s)"
            yield f"time.{name}", wrong, f"take {nearest_multiple(length, unit):.10g}"
    if ramp >= end:
        wrong = f"{ramp:g} s is not before time.end_s ({end:g} s)"
        yield "time.ramp_s", wrong, "take a shorter ramp or a later end"


@reads(
    "contact.young_modulus_Pa", "contact.poisson_ratio_1", "particles.density_kg_m3", "particles.diameter_m",
    "particles.number", "bed.width_m", "bed.thickness_m",
)  # fmt: skip
def particles_carry_the_bed(
    young: float, poisson: float, density: float, diameter: float, number: int, width: float, depth: float
) -> Iterator[Finding]:
    """Refuse particles so soft that the bed's own weight presses the lowest ones far into each other."""
    overlap = static_overlap(young, poisson, density, diameter, number, width, depth)
    if overlap > OVERLAP_AT_REST_MAX:
        stiffer = young * (overlap / OVERLAP_AT_REST_MAX) ** 1.5
        wrong = (
            f"{young:g} Pa lets the lowest particles overlap by {overlap:.3g} diameters under the settled "
            f"bed, above {OVERLAP_AT_REST_MAX:g}: (3 F / (4 E* sqrt(R*)))^(2/3) / d (Hertz)"
        )
        yield "contact.young_modulus_Pa", wrong, f"take at least {stiffer:.4g}"


@reads("particles.density_kg_m3", "gas.density_kg_m3", "gas.superficial_velocity_m_s")
def gas_is_light(density: float, gas_density: float, velocity: float) -> Iterator[Finding]:
    """Refuse a gas so dense that particles take a share of it along; no equation has that added mass."""
    share = gas_density / (2 * density)
    if share > ADDED_MASS_MAX:
        wrong = (
            f"{gas_density:g} kg/m3 among particles of {density:g} kg/m3: the added mass, rho_g / (2 rho_p), "
            f"is {share:.3g} of their own, above {ADDED_MASS_MAX:g}, and is not modelled"
        )
        yield "gas.density_kg_m3", wrong, f"take at most {rounded_down(2 * density * ADDED_MASS_MAX)}"


@reads("time.gas_step_s", "gas.cell_size_m")
def gas_step_sees_particles_fall(step: float, cell: float) -> Iterator[Finding]:
    """Refuse a step of the gas in which free particles fall through a good part of a gas cell."""
    limit = FREE_FALL_SHARE_MAX * math.sqrt(2 * cell / GRAVITY_M_S2)
    if step > limit:
        wrong = (
            f"{step:g} s is above {limit:.4g} s, {FREE_FALL_SHARE_MAX:.0%} of the time sqrt(2 cell / g) in "
            "which a particle falls through a gas cell, and its forces are as old"
        )
        yield "time.gas_step_s", wrong, f"take at most {rounded_down(limit)}, or a larger gas.cell_size_m"


@reads(
    "gas.cell_size_m", "particles.number", "particles.diameter_m", "bed.width_m", "bed.thickness_m",
    "bed.layers",
)  # fmt: skip
def gas_cells_see_the_bed(
    cell: float, number: int, diameter: float, width: float, thickness: float, layers: str
) -> Iterator[Finding]:
    """Refuse gas cells about as high as the bed: its voidage would be mixed with that of the space above."""
    height = settled_height(number, diameter, width, thickness if layers == "many" else None)
    if height >= LAYERS_MIN * diameter and cell > GAS_CELL_MAX * height:
        wrong = (
            f"{cell:g} m is above {GAS_CELL_MAX * height:.4g} m, {GAS_CELL_MAX:.0%} of the settled height "
            "N pi d^2 / (4 0.82 W): the bed's voidage would be mixed with that of the space above"
        )
        yield "gas.cell_size_m", wrong, f"take at most {rounded_down(GAS_CELL_MAX * height)}"


@reads("scene")
def gas_flows_in_a_box_and_a_drum_turns_without(scene: str) -> Iterator[Finding]:
    """Refuse a box without gas, where nothing would move the particles, and gas in a drum."""
    if scene == "box, none":
        remedy = "add drum: {revolution_s: ...}, or take coupled"
        yield "gas.model", "none leaves the particles at rest: nothing moves them but a drum", remedy
    if scene == "drum, coupled":
        yield "gas.model", "coupled does not go with a drum: the gas's cells end at flat walls", "take none"


@reads("drum.revolution_s", "bed.width_m", "bed.height_m", "bed.layers")
def drum_is_round_and_flat(revolution: float, width: float, height: float, layers: str) -> Iterator[Finding]:
    """Refuse a drum that its box does not hold exactly, or one that is more than one layer deep."""
    if width != height:
        yield "bed.height_m", f"{height:g} m is not the drum's diameter", f"take bed.width_m ({width:g} m)"
    if layers != "one":
        yield "bed.layers", "many is not there for a drum", "take one"


@reads("drum.revolution_s", "time.frame_interval_s")
def a_revolution_has_frames(revolution: float, frame: float) -> Iterator[Finding]:
    """Refuse a revolution between frames: no matrix could be that of a revolution."""
    if not is_multiple(revolution, frame):
        wrong = f"{revolution:g} s is no multiple of time.frame_interval_s ({frame:g} s)"
        yield "drum.revolution_s", wrong, f"take {nearest_multiple(revolution, frame):.10g}"


@reads("drum.revolution_s", "bed.width_m", "particles.diameter_m", "particles.number")
def particles_fit_into_the_drum(
    revolution: float, width: float, diameter: float, number: int
) -> Iterator[Finding]:
    """Refuse more particles than the lattice that they fall from has sites."""
    if diameter <= width and number > (sites := drum_sites(width, diameter)):
        wrong = f"{number} start on a lattice that has {sites} sites in a drum of {width:g} m"
        yield (
            "particles.number",
            wrong,
            f"take at most {sites}, or a larger drum (bed.width_m and bed.height_m)",
        )


@reads("drum.revolution_s", "run.dump_format", "comparison.repeats")
def drum_is_dumped_in_binary_and_once(revolution: float, form: str, repeats: int) -> Iterator[Finding]:
    """Refuse text frames, with LIGGGHTS's own names y and z, and repeats, which need a state of the gas."""
    if form != "binary":
        yield "run.dump_format", f"{form} is not there for a drum", "take binary"
    if repeats:
        yield "comparison.repeats", f"{repeats} repeats are not there for a drum", "take 0"
