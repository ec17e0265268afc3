# SPDX-License-Identifier: GPL-3.0-or-later
"""Minimum fluidization by the thickness of the slab: one settled bed, held in place, in four slabs."""

from pathlib import Path

import numpy as np

from bedchain.case_numbers import LAYER_DISTANCE
from bedchain.slab import converted_thickness
from bedchain.verification.bench import Setup, run_gas, suspension, write_inputs
from bedchain.verification.fluidization import DIAMETER, FRICTION, HEIGHT, NUMBER, WIDTH, fitted_onset
from bedchain.verification.laws import minimum_fluidization
from bedchain.verification.packing import bulk_voidage
from bedchain.verification.plots import Curve, draw
from bedchain.verification.rows import Row
from bedchain.verification.settled_bed import random_bed, settled

NEAR = 0.08  # the loose top and bottom, a tenth of the bed, let more gas through than its bulk
RAMP = 0.1  # [s], slow against the gas
REACHED = 0.8  # of u_mf, above all of the fitted part
SOURCE = "Ergun 1952 with the bed's own bulk voidage in this slab {:.3f}: pressure drop = weight"


def check(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Rows and figure: u_mf in slabs of several thicknesses, one of them that of Hoomans et al. 1996."""
    heap = random_bed(work / "slab_settling", WIDTH, HEIGHT, NUMBER, friction_1=FRICTION)
    bed = settled(work, "slab", heap, {"frozen": 1})
    solids = 1 - bulk_voidage(bed.particles[:, 1], DIAMETER, WIDTH * DIAMETER)
    converted = converted_thickness(1.5 * solids)
    names = {LAYER_DISTANCE: ", layers of closest packing", converted: ", conversion of Hoomans et al. 1996"}
    rows = []
    thicknesses = np.array([LAYER_DISTANCE, converted, 1.0, 1.25])
    for thickness in thicknesses:
        found, reference = onset(bed, solver, float(thickness), 1 - solids / thickness)
        quantity = f"u_mf in a slab of {thickness:.3g} diameters{names.get(thickness, '')} [m/s]"
        rows.append(Row(quantity, found, reference, NEAR, SOURCE.format(1 - solids / thickness)))
    values, theory = (np.array([getattr(row, name) for row in rows]) for name in ("value", "reference"))
    curve = Curve("settled bed, held", thicknesses, values, theory)
    draw(
        figures / "slab_thickness",
        [curve],
        "thickness of the slab [diameters]",
        "minimum fluidization velocity [m/s]",
    )
    return rows


def onset(bed: Setup, solver: Path, thickness: float, voidage: float) -> tuple[float, float]:
    """Velocity that carries the bed in a slab so many diameters thick [m/s]: measured, and by Ergun."""
    half = thickness * DIAMETER / 2
    slab = {"thickness": 2 * half, "slab_low": -half, "slab_high": half}
    name = f"{bed.folder.name}_{thickness:.3f}"
    setup = Setup(bed.folder.with_name(name), bed.sections, bed.particles, bed.numbers | slab)
    write_inputs(setup)
    of = suspension(setup)
    reference = minimum_fluidization(of, voidage)
    table = run_gas(setup, solver, RAMP, f"table ((0 0) ({RAMP} {REACHED * reference}))")
    weight = NUMBER * of.weight / (WIDTH * 2 * half)
    return fitted_onset(table, (0, RAMP), weight, reference), reference
