# SPDX-License-Identifier: GPL-3.0-or-later
"""Conservation: volume of the gas, momentum of gas and particles together, particles, falling energy."""

from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from bedchain.dem.lattices import loose_lattice
from bedchain.dem.small_cases import Setup, run_gas, run_particles
from bedchain.studies.verification.laws import GRAVITY, Suspension, suspension
from bedchain.studies.verification.plots import Curve, draw
from bedchain.studies.verification.rows import Row

ROUND_OFF = 1e-11  # relative: sums over some hundred particles, and a linear solve to 1e-13
ENERGY_STORED = 1e-6  # of the energy at the start: what tangential springs hold, which is not counted
WIDTH, HEIGHT, NUMBER, DIAMETER = 0.04, 0.08, 600, 1e-3
YOUNG, POISSON = 1.9e6, 0.3
SETTLE, FRAME = 0.3, 1e-3  # [s]
FLUIDIZE, VELOCITY = 0.04, 1.5  # [s], [m/s]


def heap(folder: Path, **gas: float) -> Setup:
    """A loose heap in a small box."""
    sections = {
        "bed": {"width_m": WIDTH, "height_m": HEIGHT},
        "contact": {"young_modulus_Pa": YOUNG, "poisson_ratio_1": POISSON},
        "gas": gas,
        "time": {"frame_interval_s": FRAME},
    }
    return Setup(folder, sections, loose_lattice(WIDTH, NUMBER, DIAMETER, np.random.default_rng(2)))


def elastic_energy(x: np.ndarray, z: np.ndarray) -> float:
    """Energy in the normal springs of all contacts, spheres and walls [J]: 8/15 E* sqrt(R*) overlap^(5/2)."""
    radius, modulus = DIAMETER / 2, YOUNG / (2 * (1 - POISSON**2))
    places = np.column_stack([x, z])
    pairs = cKDTree(places).query_pairs(DIAMETER, output_type="ndarray")
    between = DIAMETER - np.linalg.norm(places[pairs[:, 0]] - places[pairs[:, 1]], axis=1)
    wall = np.maximum(0, radius - np.concatenate([x, WIDTH - x, z]))
    total = (radius / 2) ** 0.5 * (between**2.5).sum() + radius**0.5 * (wall**2.5).sum()
    return float(8 / 15 * modulus * total)


def energies(frames: np.ndarray, of: Suspension) -> np.ndarray:
    """Kinetic, rotational, potential and normal elastic energy of each frame [J], (n_frames, 4)."""
    inertia = 0.1 * of.mass * of.diameter**2
    return np.array(
        [
            (
                0.5 * of.mass * (frame[:, 3:5] ** 2).sum(),
                0.5 * inertia * (frame[:, 5] ** 2).sum(),
                of.mass * GRAVITY * frame[:, 2].sum(),
                elastic_energy(frame[:, 1], frame[:, 2]),
            )
            for frame in frames
        ]
    )


def check_settling(work: Path, figures: Path) -> list[Row]:
    """Rows and figure of a heap that falls without gas."""
    setup = heap(work / "heap_settling")
    frames = run_particles(setup, SETTLE)
    parts = energies(frames, suspension(setup))
    total = parts.sum(axis=1)
    times = FRAME * np.arange(len(total))
    rise = float(np.maximum(np.diff(total), 0).max() / total[0])
    lost = float(len(set(frames[0, :, 0]) ^ set(frames[-1, :, 0])))
    falling = np.minimum.accumulate(total)
    draw(figures / "heap_energy", [Curve("kinetic, potential and elastic", times, total, falling)],
         "time [s]", "energy of a heap that falls [J]", line="never rising")  # fmt: skip
    source = "no force but weight and contacts that dissipate"
    return [
        Row("particles lost while settling [1]", lost, 0, 0, "conservation of particles"),
        Row("largest rise of a falling heap's energy over its start [1]", rise, 0, ENERGY_STORED, source),
        Row(
            "kinetic energy left after settling over potential [1]",
            parts[-1, 0] / parts[-1, 2],
            0,
            1e-4,
            source,
        ),
    ]


def check_balances(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Rows and figure of a heap blown up by gas, with the gas solved to round-off."""
    setup = heap(work / "heap_blown")
    table = run_gas(setup, solver, FLUIDIZE, f"table ((0 0) ({FLUIDIZE / 2:g} {VELOCITY:g}))", tight=True)
    times = table["time_s"].to_numpy()
    balance, exchange = (table[name].to_numpy() for name in ("volume_balance_1", "exchange_error_1"))
    limit = np.full_like(times, ROUND_OFF)
    curves = [Curve("gas volume", times, balance, limit), Curve("momentum", times, exchange, limit)]
    draw(
        figures / "balances",
        curves,
        "time [s]", "imbalance [1]", logarithmic=True, line="largest allowed",
    )  # fmt: skip
    number = float(np.abs(table["particles_1"] - NUMBER).max())
    return [
        Row(
            "gas volume out of balance in a cell and step [1]",
            balance.max(),
            0,
            ROUND_OFF,
            "d(e)/dt + div(e U) = 0",
        ),
        Row(
            "momentum given to gas and particles over that exchanged [1]",
            exchange.max(),
            0,
            ROUND_OFF,
            "Newton's third law",
        ),
        Row("particles lost under gas [1]", number, 0, 0, "conservation of particles"),
    ]


def check(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Rows and figures of the falling and the blown heap."""
    return check_settling(work, figures) + check_balances(work, solver, figures)
