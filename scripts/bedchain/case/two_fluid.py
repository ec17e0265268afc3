# SPDX-License-Identifier: GPL-3.0-or-later
"""A coupled case as two fluids instead of particles and gas: what it needs, on which grids."""

from bedchain.case.schema import Case
from bedchain.errors import UserError
from bedchain.physics.whole_numbers import is_multiple

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
    return case | {"gas": gas | {"cell_size_m": cell_m}, "time": case["time"] | {"gas_step_s": step_s}}


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
