# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of parcels: enough of them in the bed, in a gas cell, and slow enough collisions."""

from collections.abc import Iterator
from typing import Any

from bedchain.case.bed_checks import BED_KEYS, particles_fit
from bedchain.case.cell_checks import BED, COUNTS, FORMS, cells_hold_particles
from bedchain.case.check_registry import Finding, reads
from bedchain.physics.parcels import particles_in
from bedchain.physics.whole_numbers import ROUND_OFF, rounded_down

KEY = "particles.parcel_diameters"
CELL_KEYS = (*FORMS, *COUNTS, *BED)
DISSIPATION_MAX = 0.95  # l (1 - e^2): beyond, the restitution of a parcel is below 0.22, and soon imaginary
GAS_CELL_MIN = 1.2  # parcels: a parcel in a smaller cell would fill it
DEPTH_MIN = 5.0  # parcels: fewer between two walls move as layers
CELL_MIN = 3.0  # parcels along a cell of the chains: below, moves between cells are those of a few parcels
WIDTH_MIN = 30.0  # parcels: bubbles of a narrower bed are a few parcels wide


@reads(KEY, "scene")
def parcels_are_under_gas(size: float, scene: str) -> Iterator[Finding]:
    """Refuse parcels without gas: what was measured of them is a fluidized bed."""
    if size > 1 and not scene.endswith("coupled"):
        yield KEY, f"{size:g} goes with gas alone, and this is a {scene.split(',')[0]} without", "take 1"


@reads(KEY, "contact.restitution_1")
def parcels_can_lose_the_energy(size: float, restitution: float) -> Iterator[Finding]:
    """Refuse parcels that would have to lose nearly all of their energy in a collision."""
    loss = 1 - restitution**2
    if size > 1 and size * loss > DISSIPATION_MAX:
        wrong = f"{size:g} makes l (1 - e^2) {size * loss:.3g}, above {DISSIPATION_MAX:g}"
        most = DISSIPATION_MAX / loss
        remedy = f"take at most {rounded_down(most)}" if most > 1 else "take 1"
        yield KEY, wrong, f"{remedy}, or a larger contact.restitution_1"


@reads(KEY, "gas.cell_size_m", "particles.diameter_m")
def gas_cells_hold_parcels(size: float, cell: float, diameter: float) -> Iterator[Finding]:
    """Refuse gas cells that one parcel would fill."""
    least = GAS_CELL_MIN * size * diameter
    if size > 1 and cell < least:
        wrong = f"{cell:g} m is below {GAS_CELL_MIN:g} parcels of {size * diameter:g} m"
        most = cell / (GAS_CELL_MIN * diameter)
        remedy = f"{KEY} at most {rounded_down(most)}" if most > 1 else f"{KEY} 1"
        yield "gas.cell_size_m", wrong, f"take at least {least:g}, or {remedy}"


@reads(KEY, *BED_KEYS, "particles.diameter_m", "particles.number")
def parcels_fit(
    size: float, width: float, height: float, thickness: float, layers: str, diameter: float, number: int
) -> Iterator[Finding]:
    """Refuse a bed too narrow, too flat or too low for its parcels."""
    if size == 1:
        return
    parcel, many = size * diameter, layers == "many"
    sizes = [("width_m", width, WIDTH_MIN), *([("thickness_m", thickness, DEPTH_MIN)] if many else [])]
    small = [(name, length, least) for name, length, least in sizes if length < least * parcel]
    for name, length, least in small:
        wrong = (
            f"{size:g} leaves {length / parcel:.3g} parcels along bed.{name} ({length:g} m), below {least:g}"
        )
        most = length / (least * diameter)
        yield KEY, wrong, f"take {f'at most {rounded_down(most)}' if most > 1 else '1'}"
    if small or any(particles_fit(width, height, thickness, layers, diameter, number)):
        return
    parcels = max(1, round(number / particles_in(size, many)))
    deep = thickness if many else thickness * size
    for _, wrong, _ in particles_fit(width, height, deep, layers, parcel, parcels):
        yield KEY, f"{size:g}: as parcels, {wrong}", "raise bed.height_m, or take smaller parcels"


@reads(KEY, *CELL_KEYS, "particles.diameter_m")
def cells_hold_parcels(size: float, form: str, axis: str, *numbers: float) -> Iterator[Finding]:
    """Refuse cells narrower than a parcel."""
    if size > 1:
        *shape, diameter = numbers
        yield from cells_hold_particles(form, axis, *shape, size * diameter)


def narrow_cells(case: dict[str, Any]) -> str:
    """Hint for a case whose cells are below `CELL_MIN` parcels wide; empty where they are not."""
    particles, cells = case.get("particles", {}), case.get("cells", {})
    size = particles.get("parcel_diameters", 1)
    if size == 1:
        return ""
    least = CELL_MIN * size * particles["diameter_m"]
    too_narrow = least * (1 - ROUND_OFF)
    sides = {
        name: case["bed"][length] / cells[name]
        for name, length in (("columns", "width_m"), ("rows", "height_m"))
        if isinstance(cells.get(name), int)
    }
    narrow = [f"cells.{name} makes {side:g} m" for name, side in sides.items() if side < too_narrow]
    return f"{', '.join(narrow)}, below {CELL_MIN:g} parcels ({least:g} m): few cross it" if narrow else ""
