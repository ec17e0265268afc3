# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of the gas: its cells, its step and its density."""

import math
from collections.abc import Iterator

from bedchain.case.check_registry import Finding, reads
from bedchain.physics.constants import GRAVITY_M_S2
from bedchain.physics.fluidization import courant_number, ergun_velocity
from bedchain.physics.packing import (
    PACKED_AREA_SHARE,
    PACKED_VOLUME_SHARE,
    settled_height,
    slab_voidage,
)
from bedchain.physics.whole_numbers import is_multiple, nearest_multiple, rounded_down

COURANT_MAX = 1.0  # a gas parcel crosses at most one cell a step
ADDED_MASS_MAX = 0.05  # of a particle's mass: the equations leave out the gas that a particle accelerates
FREE_FALL_SHARE_MAX = 0.1  # of the time to fall through a gas cell: at 0.14 a fixed bed of 0.05 mm rattled
DRAG_LAG_MAX = 0.1  # of a collision's change of velocity: drag sees contacts one gas step late
GAS_CELL_MAX = 0.5  # of the settled height: where a cell is higher than the bed the gas carries a third
LAYERS_MIN = 10  # of particles: a lower bed is nearly all top and bottom


@reads("gas.superficial_velocity_m_s", "time.gas_step_s", "gas.cell_size_m")
def gas_step_is_stable(velocity: float, step: float, cell: float) -> Iterator[Finding]:
    """Refuse a gas step in which the gas crosses more than a cell."""
    courant = courant_number(velocity, step, cell)
    if courant > COURANT_MAX:
        wrong = f"{step:g} s gives a gas Courant number of about {courant:.3g}, above {COURANT_MAX:g}"
        most = step * COURANT_MAX / courant
        yield "time.gas_step_s", wrong, f"take at most {rounded_down(most)} s, or a larger gas.cell_size_m"


@reads("gas.cell_size_m", "bed.width_m", "bed.height_m", "particles.diameter_m")
def gas_cells_fit(cell: float, width: float, height: float, diameter: float) -> Iterator[Finding]:
    """Refuse gas cells that do not divide the bed, or are smaller than a particle."""
    if cell < diameter:
        wrong = f"{cell:g} m is smaller than a particle: the gas is averaged over many"
        yield (
            "gas.cell_size_m",
            wrong,
            f"take at least particles.diameter_m ({diameter:g} m), usually 3 to 5 of it",
        )
    for name, length in (("width_m", width), ("height_m", height)):
        if not is_multiple(length, cell):
            near = length / max(1, round(length / cell))
            wrong = f"{cell:g} m does not divide bed.{name} ({length:g} m)"
            yield "gas.cell_size_m", wrong, f"take {near:.6g}, or another bed.{name}"


@reads("time.dem_step_s", "time.gas_step_s", "time.frame_interval_s", "time.ramp_s", "time.end_s")
def gas_steps_nest(dem: float, gas: float, frame: float, ramp: float, end: float) -> Iterator[Finding]:
    """Refuse a gas step that does not fit the DEM step or the frames, and a ramp that does not end."""
    pairs = [("gas_step_s", gas, "dem_step_s", dem), ("frame_interval_s", frame, "gas_step_s", gas)]
    for name, length, unit_name, unit in pairs:
        if not is_multiple(length, unit):
            wrong = f"{length:g} s is no multiple of time.{unit_name} ({unit:g} s)"
            yield f"time.{name}", wrong, f"take {nearest_multiple(length, unit):.10g}"
    if ramp >= end:
        wrong = f"{ramp:g} s is not before time.end_s ({end:g} s)"
        yield "time.ramp_s", wrong, "take a shorter ramp or a later end"


@reads("particles.density_kg_m3", "gas.density_kg_m3", "gas.superficial_velocity_m_s")
def gas_is_light(density: float, gas_density: float, velocity: float) -> Iterator[Finding]:
    """Refuse a gas so dense that the added mass of the particles counts; no equation has it."""
    share = gas_density / (2 * density)
    if share > ADDED_MASS_MAX:
        wrong = (
            f"{gas_density:g} kg/m3 among particles of {density:g} kg/m3: the added mass, rho_g / (2 rho_p), "
            f"is {share:.3g} of their mass, above {ADDED_MASS_MAX:g}, and is not modelled"
        )
        yield "gas.density_kg_m3", wrong, f"take at most {rounded_down(2 * density * ADDED_MASS_MAX)}"


@reads("time.gas_step_s", "gas.cell_size_m")
def gas_step_resolves_the_fall(step: float, cell: float) -> Iterator[Finding]:
    """Refuse a gas step in which free particles fall through a large part of a gas cell."""
    limit = FREE_FALL_SHARE_MAX * math.sqrt(2 * cell / GRAVITY_M_S2)
    if step > limit:
        wrong = (
            f"{step:g} s is above {limit:.4g} s, {FREE_FALL_SHARE_MAX:.0%} of the time sqrt(2 cell / g) in "
            "which a particle falls through a gas cell; its drag is updated once a gas step"
        )
        yield "time.gas_step_s", wrong, f"take at most {rounded_down(limit)}, or a larger gas.cell_size_m"


@reads(
    "time.gas_step_s", "particles.diameter_m", "particles.density_kg_m3", "gas.density_kg_m3",
    "gas.viscosity_Pa_s", "bed.thickness_m", "bed.layers",
)  # fmt: skip
def drag_follows_collisions(
    step: float, diameter: float, density: float, gas_density: float, viscosity: float, thickness: float,
    layers: str,
) -> Iterator[Finding]:  # fmt: skip
    """Refuse a gas step in which drag takes a large part of what a collision changes.

    Drag is implicit in the velocity without the contacts of the present step: of a collision's change it is
    wrong by dt K/m / 2. At minimum fluidization drag carries the share e of the weight, the pressure the
    rest: K/m is e g (1 - rho_g / rho_p) over the slip u_mf / e.
    """
    packed = slab_voidage(PACKED_AREA_SHARE, thickness / diameter)
    voidage = 1 - PACKED_VOLUME_SHARE if layers == "many" else packed
    if not 0 < voidage < 1 or density <= gas_density:
        return
    slip = ergun_velocity(voidage, diameter, density, gas_density, viscosity) / voidage
    rate = voidage * GRAVITY_M_S2 * (1 - gas_density / density) / slip
    limit = 2 * DRAG_LAG_MAX / rate
    if step > limit:
        wrong = (
            f"{step:g} s is above {limit:.4g} s: drag, which is dt K/m / 2 late, would be wrong by more than "
            f"{DRAG_LAG_MAX:.0%} of what a collision changes (K/m = {rate:.4g} 1/s at minimum fluidization)"
        )
        yield "time.gas_step_s", wrong, f"take at most {rounded_down(limit)}"


@reads(
    "gas.cell_size_m", "particles.number", "particles.diameter_m", "bed.width_m", "bed.thickness_m",
    "bed.layers",
)  # fmt: skip
def gas_cells_resolve_the_bed(
    cell: float, number: int, diameter: float, width: float, thickness: float, layers: str
) -> Iterator[Finding]:
    """Refuse gas cells about as high as the bed: they would mix its voidage with that of the freeboard."""
    height = settled_height(number, diameter, width, thickness if layers == "many" else None)
    if height >= LAYERS_MIN * diameter and cell > GAS_CELL_MAX * height:
        wrong = (
            f"{cell:g} m is above {GAS_CELL_MAX * height:.4g} m, {GAS_CELL_MAX:.0%} of the settled height "
            "N pi d^2 / (4 0.82 W): the bed's voidage would be mixed with that of the space above"
        )
        yield "gas.cell_size_m", wrong, f"take at most {rounded_down(GAS_CELL_MAX * height)}"
