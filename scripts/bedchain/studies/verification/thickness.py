# SPDX-License-Identifier: GPL-3.0-or-later
"""Minimum fluidization by the thickness of the slab: one settled bed, held in place, in four slabs."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from bedchain.dem.lattices import bulk_voidage, rows_of_voidage
from bedchain.dem.small_cases import Setup, run_gas
from bedchain.physics.packing import LAYER_DISTANCE, converted_thickness
from bedchain.studies.verification.fluidization import fitted_onset
from bedchain.studies.verification.laws import Suspension, ergun_gradient, suspension
from bedchain.studies.verification.plots import Curve, draw
from bedchain.studies.verification.rows import Row
from bedchain.studies.verification.settled_bed import CELL, DIAMETER, HEIGHT, NUMBER, WIDTH, settled

NEAR = 0.06  # the kernel smears the bed's surface, 2 %; cells of a row are not alike, 2 %
RAMP = 0.05  # [s], slow against the gas: its inertia takes 0.2 % of the pressure drop
REACHED = 0.8  # of u_mf, above all of the fitted part
SOURCE = "Ergun 1952 over rows of the voidage from the positions, {:.3f} in the bulk: pressure drop = weight"


def fluidizing_speed(of: Suspension, z: np.ndarray, thickness: float) -> float:
    """Velocity at which Ergun's pressure drop over rows of the bed is its weight per area [m/s].

    Parameters
    ----------
    of : Suspension
    z : (n,) ndarray
        Heights of the spheres' centres [m].
    thickness : float
        Of the slab [m].
    """
    edges = np.linspace(0, HEIGHT, round(HEIGHT / CELL) + 1)
    voidage = rows_of_voidage(z, of.diameter, edges, WIDTH * thickness)
    weight = len(z) * of.weight / (WIDTH * thickness)

    def surplus(speed: float) -> float:
        return sum(ergun_gradient(of, e, speed) for e in voidage) * CELL - weight

    return float(brentq(surplus, 1e-3, 10))


def onset(bed: Setup, solver: Path, of: Suspension, thickness: float) -> tuple[float, float, float]:
    """Minimum fluidization velocity in a slab of a thickness [m]: measured, its error, and by Ergun [m/s]."""
    slab = {"thickness": thickness, "slab_low": -thickness / 2, "slab_high": thickness / 2}
    folder = bed.folder.with_name(f"slab_{thickness / DIAMETER:.3f}")
    setup = replace(bed, folder=folder, numbers={"frozen": 1} | slab)
    reference = fluidizing_speed(of, bed.particles[:, 1], thickness)
    table = run_gas(setup, solver, RAMP, f"table ((0 0) ({RAMP} {REACHED * reference}))")
    weight = NUMBER * of.weight / (WIDTH * thickness)
    return *fitted_onset(table, (0, RAMP), weight, reference), reference


def check(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Rows and figure of u_mf in slabs of several thicknesses, among them that of Hoomans et al. 1996."""
    bed = settled(work)
    of = suspension(bed)
    solids = 1 - bulk_voidage(bed.particles[:, 1], DIAMETER, WIDTH * DIAMETER)
    converted = converted_thickness(1.5 * solids)
    names = {LAYER_DISTANCE: ", layers of closest packing", converted: ", conversion of Hoomans et al. 1996"}
    rows = []
    thicknesses = [LAYER_DISTANCE, converted, 1.0, 1.25]
    for thickness in thicknesses:
        measured, error, reference = onset(bed, solver, of, thickness * DIAMETER)
        quantity = f"u_mf in a slab of {thickness:.3g} diameters{names.get(thickness, '')} [m/s]"
        source = SOURCE.format(1 - solids / thickness)
        rows.append(Row(quantity, measured, reference, NEAR, source, error))
    values, theory = (np.array([getattr(row, name) for row in rows]) for name in ("value", "reference"))
    draw(
        figures / "slab_thickness", [Curve("settled bed, held", np.array(thicknesses), values, theory)],
        "thickness of the slab [diameters]", "minimum fluidization velocity [m/s]",
    )  # fmt: skip
    return rows
