# SPDX-License-Identifier: GPL-3.0-or-later
"""A bed as two fluids instead of particles and gas: what it needs, on which grids; cases that are one."""

from collections.abc import Iterator
from typing import Any

from bedchain.case.check_registry import Finding, reads
from bedchain.case.schema import Case
from bedchain.errors import Problem, UserError
from bedchain.physics.whole_numbers import is_multiple

TWO_FLUID = "two_fluid"  # of gas.model
# sections of a case of two fluids, and the keys of those that it uses in part
SECTIONS = (
    *("title", "seed", "bed", "particles", "contact", "gas"),
    *("time", "learning", "comparison", "mixing", "figures"),
)
USED = {
    "particles": ("number", "diameter_m", "density_kg_m3"),
    "contact": ("restitution_1",),
    "time": ("gas_step_s", "ramp_s", "end_s", "frame_interval_s", "segment_s"),
    "comparison": ("start_s", "end_s"),
    "figures": ("resolution_dpi",),
}

DRAG = {"gidaspow": "GidaspowErgunWenYu", "wen_yu": "WenYu"}  # of a case, in OpenFOAM's words
GRIDS = (2, 1)  # cells of the ladder's runs, in gas cells of the case


def two_fluid_case(case: Case, cell_m: float | None = None) -> Case:
    """A coupled case as two fluids, on cells of another edge [m] with a gas step of the same Courant number.

    Raises
    ------
    UserError
        The bed is deep or a drum, has no gas, a drag law that OpenFOAM lacks, or cells that do not divide it.
    """
    gas, bed = case["gas"], case["bed"]
    cell_m = gas["cell_size_m"] if cell_m is None else cell_m
    if "drum" in case or gas["model"] == "none" or bed["layers"] != "one":
        raise UserError(
            "two fluids take a bed of one layer with gas: gas.model coupled, bed.layers one, no drum"
        )
    if gas["drag_law"] not in DRAG:
        raise UserError(
            f"two fluids have no drag law {gas['drag_law']}: take gas.drag_law {' or '.join(DRAG)}"
        )
    if not all(is_multiple(bed[name], cell_m) for name in ("width_m", "height_m")):
        raise UserError(
            f"cells of {cell_m:g} m do not divide a bed of {bed['width_m']:g} x {bed['height_m']:g} m"
        )
    step_s = case["time"]["gas_step_s"] * cell_m / gas["cell_size_m"]
    frame_s = case["time"]["frame_interval_s"]
    step_s = frame_s / max(round(frame_s / step_s), 1)
    particles = case["particles"] | {"parcel_diameters": 1.0}
    changed = {"gas": gas | {"cell_size_m": cell_m}, "time": case["time"] | {"gas_step_s": step_s}}
    return case | changed | {"particles": particles}


def is_two_fluid(case: dict[str, Any]) -> bool:
    """Whether a case, checked or not, is one of two fluids."""
    gas = case.get("gas")
    return isinstance(gas, dict) and gas.get("model") == TWO_FLUID


def particle_problems(data: dict[str, Any], known: dict[str, Any], lines: dict[str, int]) -> list[Problem]:
    """Sections and keys of particles in a case of two fluids, which has none.

    Parameters
    ----------
    data : dict
        The case as written.
    known : dict
        Sections of the schema.
    lines : dict of str to int
        Of the case's file, by key.
    """
    given = [name for name in data if name in known and name not in SECTIONS]
    for section, used in USED.items():
        keys, properties = data.get(section), known[section].get("properties", {})
        if isinstance(keys, dict):
            given += [f"{section}.{name}" for name in keys if name in properties and name not in used]
    remedy = "leave it out, or take gas.model: coupled"
    return [
        Problem(name, "belongs to particles, and two fluids have none", remedy, lines.get(name))
        for name in given
    ]


def without_particles(case: dict[str, Any]) -> dict[str, Any]:
    """A case of two fluids less the keys that only particles use, which the schema has filled."""
    used = {name: value for name, value in case.items() if name in SECTIONS}
    for section, keys in USED.items():
        if isinstance(filled := case.get(section), dict):
            used[section] = {key: value for key, value in filled.items() if key in keys}
    return used


@reads("scene", "bed.layers", "gas.drag_law", "gas.cell_size_m", "time.gas_step_s", "time.frame_interval_s")
def two_fluids_are_flat_and_have_their_drag_law(
    scene: str, layers: str, drag: str, cell: float, step: float, frame: float
) -> Iterator[Finding]:
    """Refuse two fluids in a drum or a deep bed, by a drag law that OpenFOAM lacks, and an uneven step."""
    if scene == f"drum, {TWO_FLUID}":
        yield "gas.model", "two_fluid does not go with a drum", "take none, or leave drum out"
    if not scene.endswith(TWO_FLUID):
        return
    if layers != "one":
        yield "bed.layers", "many is not possible for two fluids", "take one"
    if drag not in DRAG:
        yield "gas.drag_law", f"two fluids have no drag law {drag}", f"take {' or '.join(DRAG)}"
    if not is_multiple(frame, step):
        wrong = f"{frame:g} s is no multiple of time.gas_step_s ({step:g} s)"
        yield "time.frame_interval_s", wrong, "take a multiple"


def two_fluid_grids(case: Case) -> list[str]:
    """Cells of the ladder's two-fluid runs of a case [mm]; none where it cannot be one of two fluids."""
    cells = [factor * case["gas"]["cell_size_m"] for factor in GRIDS]
    fitting = []
    for cell_m in cells:
        try:
            two_fluid_case(case, cell_m)
        except UserError:
            continue
        fitting.append(f"{1000 * cell_m:g}")
    return fitting
