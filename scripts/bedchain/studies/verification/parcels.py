# SPDX-License-Identifier: GPL-3.0-or-later
"""Parcels against the particles that they stand for: drag, fluidization, restitution, cooling."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from bedchain.dem.lattices import lattice, spheres_at_rest
from bedchain.dem.small_cases import Setup, run_gas, run_particles
from bedchain.physics.parcels import parcel_restitution
from bedchain.studies.verification import settling, uniform_bed
from bedchain.studies.verification.fluidization import (
    FASTEST,
    NUMBER,
    RAMP,
    UP,
    WIDTH,
    fitted_onset,
    ramped_bed,
)
from bedchain.studies.verification.laws import LAWS, ergun_gradient, minimum_fluidization, suspension
from bedchain.studies.verification.plots import Curve, draw
from bedchain.studies.verification.rows import Row
from bedchain.studies.verification.settled_bed import CELL, HEIGHT, settled
from bedchain.uncertainty.bands import block_error, kept_blocks, kept_steps

NEAR_DRAG, NEAR_ONSET, NEAR_RESTITUTION, NEAR_COOLING = 0.001, 0.02, 0.005, 0.05
SIZE = 2.0  # diameters of a parcel
DIAMETER = 1e-3  # of a particle [m]
RESTITUTION = 0.9
SIZES = (2.0, 4.0)  # of the impacts
SPEED = 0.5  # [m/s], of either parcel before an impact
DEEP = 5.0  # [m], of the slab that a parcel falls in: the gas of one cell weighs more than 10 000 parcels
VOIDAGE = 0.5  # of the bed, to find the packed part of its curve
COLLIDING = 2500  # parcels of the granular gas
COVERED = 0.2  # of the plane, by the parcels
FLUCTUATION = 0.2  # [m/s], root of the granular temperature at the start
COOLING, FRAME = 0.06, 2e-3  # [s]
MIXED = 0.016  # [s], two collisions: the lattice of the start is forgotten


def check_fall(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Rows and figure of a parcel that falls as fast as its particles, by each drag law."""
    rows, curves = [], []
    for name, law in LAWS.items():
        single = settling.setup_of(work / f"parcel_falls_{name}", name)
        sections = single.sections | {
            "bed": single.sections["bed"] | {"thickness_m": DEEP},
            "particles": single.sections["particles"] | {"parcel_diameters": SIZE},
        }
        parcel = single.particles * [1, 1, 1, 1, SIZE]
        setup = Setup(single.folder, sections, parcel, single.numbers | {"number": 1})
        times, momentum, theory = settling.fall(setup, solver, law, settling.DURATION, row_every=5)
        speed = momentum * SIZE**-1.5  # the energy is that of a parcel, the mass a particle's
        source = f"{settling.SOURCE.format(name)}, of one particle"
        quantity = f"speed of a falling parcel of {SIZE:g} diameters at the end, {name} [m/s]"
        rows.append(Row(quantity, speed[-1], theory[-1], NEAR_DRAG, source))
        curves.append(Curve(name, times, speed, theory))
    draw(figures / "parcel_falls", curves, "time [s]", "speed of a falling parcel [m/s]")
    return rows


def check_lattice(work: Path, solver: Path) -> list[Row]:
    """Rows of the pressure drop of parcels held on a lattice, by Ergun with the particles' diameter."""
    parcel, width, height = SIZE * DIAMETER, 0.06, 0.1
    sections: dict[str, dict[str, Any]] = {
        "bed": {"width_m": width, "height_m": height},
        "particles": {"number": 1, "parcel_diameters": SIZE},
        "time": {"frame_interval_s": uniform_bed.HOLD},
    }
    spheres = lattice(width, height, parcel, parcel)
    setup = Setup(work / "parcel_lattice", sections, spheres, {"frozen": 1, "number": len(spheres)})
    span = len(uniform_bed.VELOCITIES) * uniform_bed.HOLD
    drops = uniform_bed.held_pressure(run_gas(setup, solver, span, uniform_bed.steps_of_velocity()))
    of = suspension(setup)
    return [
        Row(
            f"lattice of parcels at {velocity:.3g} m/s: pressure drop over height [Pa/m]",
            drop / height, ergun_gradient(of, 1 - np.pi / 6, velocity), NEAR_DRAG,
            f"{uniform_bed.ERGUN}, diameter of the particles",
        )
        for velocity, drop in zip(uniform_bed.VELOCITIES, drops, strict=True)
    ]  # fmt: skip


def onset(setup: Setup, table: pd.DataFrame) -> tuple[float, float]:
    """Minimum fluidization velocity of a settled bed as gas rises through it, and its error [m/s]."""
    of, bed = suspension(setup), setup.sections["bed"]
    size = setup.particles[0, 4] / DIAMETER
    weight = len(setup.particles) * size**3 * of.weight / (bed["width_m"] * size * DIAMETER)
    return fitted_onset(table, UP, weight, minimum_fluidization(of, VOIDAGE))


def check_onset(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Row and figure of the velocity that fluidizes a bed of parcels, packed as one of particles is."""
    single = settled(work, WIDTH, NUMBER)
    sections = single.sections | {
        "bed": {"width_m": WIDTH * SIZE, "height_m": HEIGHT * SIZE},
        "particles": {"number": round(NUMBER * SIZE**2), "parcel_diameters": SIZE},
        # as many parcels in a cell as particles: the surface of the bed is as sharp
        "gas": {"cell_size_m": CELL * SIZE},
    }
    x, z = single.particles[:, :2].T * SIZE
    scaled = Setup(work / "parcels_rise", sections, spheres_at_rest(x, z, SIZE * DIAMETER))
    parcels, error = onset(scaled, run_gas(scaled, solver, RAMP, f"table ((0 0) ({RAMP} {FASTEST}))"))
    speeds = [onset(*ramped_bed(work, solver))[0], parcels]
    draw(
        figures / "parcel_onset",
        [Curve("one packing", np.array([1, SIZE]), np.array(speeds), np.full(2, speeds[0]))],
        "parcel over particle diameter [1]", "minimum fluidization velocity [m/s]",
    )  # fmt: skip
    quantity = f"minimum fluidization velocity of parcels of {SIZE:g} diameters [m/s]"
    return [Row(quantity, parcels, speeds[0], NEAR_ONSET, "the same packing of single particles", error)]


def check_impact(work: Path) -> list[Row]:
    """Rows of the restitution of two parcels that collide head on."""
    rows = []
    for size in SIZES:
        parcel = size * DIAMETER
        sections: dict[str, dict[str, Any]] = {
            "bed": {"width_m": 0.12, "height_m": 0.12},
            "particles": {"number": round(2 * size**2), "parcel_diameters": size},
            "contact": {"young_modulus_Pa": 5e6, "restitution_1": RESTITUTION},
            "time": {"dem_step_s": 2e-6, "gas_step_s": 1e-4, "frame_interval_s": 4e-3},
        }
        x = np.array([0.05, 0.05 + parcel + 2e-4])
        spheres = spheres_at_rest(x, np.full(2, 0.06), parcel)
        spheres[:, 2] = SPEED, -SPEED
        setup = Setup(work / f"parcel_impact_{size:g}", sections, spheres, {"gravity": 0.0})
        before, after = run_particles(setup, 4e-3)[[0, -1], :, 3]
        ratio = (after[1] - after[0]) / (before[0] - before[1])
        expected = parcel_restitution(RESTITUTION, size)
        quantity = f"restitution of parcels of {size:g} diameters, of particles {RESTITUTION:g} [1]"
        rows.append(Row(quantity, ratio, expected, NEAR_RESTITUTION, "1 - e_cg^2 = l (1 - e^2)"))
    return rows


def cooling_rate(side: float) -> float:
    """Rise of 1/sqrt(T) over time by collisions in a square box [1/m], T the variance along an axis.

    Haff 1983, J. Fluid Mech. 134, 401, in two dimensions: a collision loses (1 - e^2) T on average, and a
    disc has 2 sqrt(pi) n d g sqrt(T) of them a second, with g of Henderson 1975, Mol. Phys. 30, 971. The
    walls take (1 - e_cg^2) T of each parcel that hits them: perimeter sqrt(T / (2 pi)) / area a second.
    """
    contact_value = (1 - 7 / 16 * COVERED) / (1 - COVERED) ** 2
    hits = 2 * np.sqrt(np.pi) * COVERED / (np.pi / 4 * DIAMETER) * contact_value
    walls = 4 / side / np.sqrt(2 * np.pi)
    lost = 1 - parcel_restitution(RESTITUTION, SIZE) ** 2
    return float((1 - RESTITUTION**2) * hits / 4 + lost * walls / 2)


def check_cooling(work: Path, figures: Path) -> list[Row]:
    """Row and figure of a granular gas of parcels that cools as one of particles, without weight."""
    parcel = SIZE * DIAMETER
    spacing = parcel * np.sqrt(np.pi / 4 / COVERED)
    side = spacing * round(np.sqrt(COLLIDING))
    sections: dict[str, dict[str, Any]] = {
        "bed": {"width_m": float(side), "height_m": float(side)},
        "particles": {"number": round(COLLIDING * SIZE**2), "parcel_diameters": SIZE},
        "contact": {"young_modulus_Pa": 5e6, "restitution_1": RESTITUTION, "friction_1": 0.0},
        "time": {"dem_step_s": 1e-5, "gas_step_s": 1e-4, "frame_interval_s": FRAME},
        "gas": {"cell_size_m": float(side) / 30},
    }
    spheres = lattice(side, side, spacing, parcel)
    spheres[:, 2:4] = np.random.default_rng(1).normal(0, FLUCTUATION, (len(spheres), 2))
    setup = Setup(work / "parcel_cooling", sections, spheres, {"gravity": 0.0, "roof": 1})
    frames = run_particles(setup, COOLING)
    times = FRAME * np.arange(len(frames))
    slowness = frames[:, :, 3:5].var(axis=(1, 2)) ** -0.5
    late = times >= MIXED
    rate, start = np.polyfit(times[late], slowness[late], 1)
    parts = [kept_steps(kept, int(late.sum())) for kept in kept_blocks()]
    error = block_error(np.array([np.polyfit(times[late], slowness[late], 1, w=part)[0] for part in parts]))
    theory = cooling_rate(float(side))
    draw(
        figures / "parcel_cooling", [Curve("parcels", times, slowness, start + theory * times)],
        "time [s]", "1 / root of the granular temperature [s/m]",
    )  # fmt: skip
    quantity = f"rate of cooling of parcels of {SIZE:g} diameters, d(1/sqrt T)/dt [1/m]"
    source = "Haff 1983 for the particles, with the loss at the walls"
    return [Row(quantity, rate, theory, NEAR_COOLING, source, float(error))]


def check(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Rows and figures of parcels."""
    return [
        *check_fall(work, solver, figures),
        *check_lattice(work, solver),
        *check_onset(work, solver, figures),
        *check_impact(work),
        *check_cooling(work, figures),
    ]
