# SPDX-License-Identifier: GPL-3.0-or-later
"""Gas through a settled random bed held in place: pressure drop by its voidage, flow at the surface."""

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bedchain.dem.gas_field import read_gas_field
from bedchain.dem.lattices import loose_lattice, rows_of_voidage, spheres_at_rest
from bedchain.dem.small_cases import Setup, run_gas, run_particles
from bedchain.studies.verification.laws import Suspension, ergun_gradient, suspension
from bedchain.studies.verification.plots import Curve, draw
from bedchain.studies.verification.rows import Row
from bedchain.uncertainty.bands import mean_error

NEAR = 0.05
NEAR_INSIDE = 0.02
NEAR_FLOW = 0.20  # cells across the surface share a jump of voidage from 0.4 to 1
VELOCITIES = (0.2, 0.5, 1.0, 2.0)  # [m/s], a decade
WIDTH, HEIGHT, NUMBER, DIAMETER = 0.04, 0.12, 2800, 1e-3  # settles about 7 cm deep
FRICTION = 0.1  # less than a case's: a bed held by its side walls lets the gas carry less than its weight
CELL = 5e-3  # [m], of the gas: the voidage is measured in rows of it
SETTLE = 0.3  # [s], after 0.26 no sphere moves by a micrometre
HELD = 0.02  # [s], a hundred relaxation times of the gas
BED = 0.5  # voidage below which a row is bed
SOURCE = "Ergun 1952, Chem. Eng. Prog. 48, 89, eq. (11), over rows of the voidage measured from the positions"


class Flow(NamedTuple):
    """Pressure and flow of the gas at one velocity.

    Attributes
    ----------
    drop : float
        Pressure drop from the inlet to the outlet [Pa].
    pressure : (n_rows, n_columns) ndarray
        In each cell, by rows [Pa].
    carried : (n_rows,) ndarray
        Voidage times rising velocity, mean in each row, over the superficial velocity [1].
    """

    drop: float
    pressure: np.ndarray
    carried: np.ndarray


@cache
def settled(work: Path, width: float = WIDTH, number: int = NUMBER) -> Setup:
    """A loose heap of spheres that has fallen into a box and rests, once for all checks in a folder."""
    sections = {
        "bed": {"width_m": width, "height_m": HEIGHT},
        "contact": {"friction_1": FRICTION},
        "time": {"frame_interval_s": HELD},
    }
    loose = loose_lattice(width, number, DIAMETER, np.random.default_rng(1))
    heap = Setup(work / f"heap_{number}", sections, loose)
    last = run_particles(heap, SETTLE)[-1]
    return replace(heap, particles=spheres_at_rest(last[:, 1], last[:, 2], DIAMETER))


def rows_of(case: Path, name: str) -> np.ndarray:
    """A field of the gas by rows of cells from the bottom up, (n_rows, n_columns[, 3])."""
    field = read_gas_field(case, name)
    heights = field.z_m.round(6)
    order = np.lexsort((field.x_m, heights))
    return np.asarray(field.values[order].reshape(len(set(heights)), -1, *field.values.shape[1:]))


def flow_through(bed: Setup, solver: Path, velocity: float) -> Flow:
    """Run the gas at one velocity until it is steady."""
    table = run_gas(bed, solver, HELD, f"constant {velocity}")
    gas = bed.folder / "gas"
    pressure = suspension(bed).gas_density * rows_of(gas, "p")
    rising = (rows_of(gas, "voidage") * rows_of(gas, "U")[..., 2]).mean(axis=1)
    return Flow(float(table["pressure_drop_Pa"].iloc[-1]), pressure, rising / velocity)


def expected_drop(of: Suspension, z: np.ndarray, edges: np.ndarray, velocity: float) -> float:
    """Ergun's pressure drop over rows between planes [Pa], each with its measured voidage."""
    voidage = rows_of_voidage(z, DIAMETER, edges, WIDTH * DIAMETER)
    gradients = np.array([ergun_gradient(of, e, velocity) for e in voidage])
    return float((gradients * np.diff(edges)).sum())


def check(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Rows and figure of the settled bed."""
    bed = replace(settled(work), folder=work / "bed_held", numbers={"frozen": 1})
    z = bed.particles[:, 1]
    edges = np.linspace(0, HEIGHT, round(HEIGHT / CELL) + 1)
    inside = np.flatnonzero(rows_of_voidage(z, DIAMETER, edges, WIDTH * DIAMETER) < BED)[1:-1]
    centres = (edges[inside] + edges[inside + 1]) / 2
    rows, drops, theory = [], [], []
    for velocity in VELOCITIES:
        flow, of = flow_through(bed, solver, velocity), suspension(bed)
        whole, part = (expected_drop(of, z, planes, velocity) for planes in (edges, centres))
        between = flow.pressure[inside[0]] - flow.pressure[inside[-1]]
        of_whole, of_part = (float(mean_error(columns)) for columns in (flow.pressure[0], between))
        off = float(np.abs(flow.carried - 1).max())
        name = f"settled bed at {velocity:g} m/s"
        rows += [
            Row(f"{name}: pressure drop [Pa]", flow.drop, whole, NEAR, SOURCE, of_whole),
            Row(
                f"{name}: pressure drop between rows inside [Pa]",
                float(between.mean()),
                part,
                NEAR_INSIDE,
                SOURCE,
                of_part,
            ),
            Row(
                f"{name}: largest gap of a row's flow from that given [1]", off, 0, NEAR_FLOW, "div(e U) = 0"
            ),
        ]
        drops.append(flow.drop)
        theory.append(whole)
    curve = Curve("settled random bed", np.array(VELOCITIES), np.array(drops), np.array(theory))
    draw(
        figures / "settled_bed", [curve], "superficial velocity [m/s]", "pressure drop [Pa]", logarithmic=True
    )
    return rows
