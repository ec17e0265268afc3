# SPDX-License-Identifier: GPL-3.0-or-later
"""Minimum fluidization: gas through a settled bed, faster and then slower, and its pressure drop."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd

from bedchain.dem.lattices import bulk_voidage
from bedchain.dem.particle_files import read_frames
from bedchain.dem.small_cases import Setup, run_gas
from bedchain.studies.verification.laws import (
    GRAVITY,
    Suspension,
    ergun_gradient,
    minimum_fluidization,
    suspension,
)
from bedchain.studies.verification.plots import Curve, draw
from bedchain.studies.verification.rows import Row
from bedchain.studies.verification.settled_bed import DIAMETER, settled
from bedchain.uncertainty.bands import block_error, kept_blocks, kept_steps, mean_error

NEAR = 0.10
NEAR_WEIGHT = 0.02
WIDTH, NUMBER = 0.03, 1500  # settles about 5 cm deep
FASTEST, RAMP, HOLD = 0.85, 0.3, 0.1  # [m/s], [s] up and as long down, [s] at the fastest
PACKED = (0.3, 0.75)  # of u_mf: the part of the curve to which Ergun's form is fitted
SOURCE = "Ergun 1952 with the bed's own bulk voidage {:.3f}: pressure drop = weight"
UP, DOWN = (0.0, RAMP), (RAMP + HOLD, 2 * RAMP + HOLD)


def fitted_onset(
    table: pd.DataFrame, span: tuple[float, float], weight: float, guess: float
) -> tuple[float, float]:
    """Velocity at which the curve of the packed bed, a U + b U^2, reaches the weight per area, and its error.

    Parameters
    ----------
    table : DataFrame
        Rows of bed_series.csv.
    span : (float, float)
        First and last time [s].
    weight : float
        Weight per area [Pa].
    guess : float
        Rough minimum fluidization velocity [m/s], to find the packed part of the curve.

    Returns
    -------
    onset, error : float
        [m/s]; blocks that are neighbours on the curve make the error up to twice that of the scatter alone.
    """
    speed, drop = table["inlet_velocity_m_s"].to_numpy(), table["pressure_drop_Pa"].to_numpy()
    part = table["time_s"].between(*span).to_numpy()
    part = part & (speed > PACKED[0] * guess) & (speed < PACKED[1] * guess)
    speed, drop = speed[part], drop[part]

    def onset(weights: np.ndarray) -> float:
        rows = weights[:, None] * np.column_stack([speed, speed**2])
        linear, square = np.linalg.lstsq(rows, weights * drop, rcond=None)[0]
        return float(2 * weight / (linear + np.sqrt(linear**2 + 4 * square * weight)))

    left_out = np.array([onset(kept_steps(kept, len(speed))) for kept in kept_blocks()])
    return onset(np.ones(len(speed))), float(block_error(left_out))


@cache
def ramped_bed(work: Path, solver: Path) -> tuple[Setup, pd.DataFrame]:
    """Ramp the gas up and down through the settled bed."""
    setup = replace(settled(work, WIDTH, NUMBER), folder=work / "ramp")
    ends = f"({RAMP} {FASTEST}) ({RAMP + HOLD} {FASTEST}) ({2 * RAMP + HOLD} 0)"
    return setup, run_gas(setup, solver, DOWN[1], f"table ((0 0) {ends})", row_every=1)


def voidage_under_gas(frames: np.ndarray, at_rest: int, table: pd.DataFrame, of: Suspension) -> float:
    """Bulk voidage at the fast end of the packed part [1], where gas unloads contacts and loosens the bed.

    Parameters
    ----------
    frames : (n_frames, n, 6) ndarray
        Of the ramps, evenly over the table's times.
    at_rest : int
        The frame without gas, first or last.
    table : DataFrame
        Rows of bed_series.csv.
    of : Suspension
    """
    voidages = [bulk_voidage(frame[:, 2], DIAMETER, WIDTH * DIAMETER) for frame in frames]
    times = np.linspace(0, DOWN[1], len(frames))
    speeds = np.interp(times, table["time_s"], table["inlet_velocity_m_s"])
    fastest = PACKED[1] * minimum_fluidization(of, voidages[at_rest])
    ramp = times <= UP[1] if at_rest == 0 else times >= DOWN[0]
    nearest = np.where(ramp, np.abs(speeds - fastest), np.inf).argmin()
    return voidages[nearest]


def curve_of(
    name: str, table: pd.DataFrame, span: tuple[float, float], of: Suspension, voidage: float
) -> Curve:
    """Pressure drop over velocity of one ramp, and the theory: Ergun up to the weight per area."""
    part = table[table["time_s"].between(*span)].sort_values("inlet_velocity_m_s")
    speed = part["inlet_velocity_m_s"].to_numpy()
    weight = NUMBER * of.weight / (WIDTH * DIAMETER)
    height = NUMBER * of.volume / (WIDTH * DIAMETER * (1 - voidage))
    packed = np.array([ergun_gradient(of, voidage, u) * height for u in speed])
    return Curve(name, speed, part["pressure_drop_Pa"].to_numpy(), np.minimum(packed, weight))


def plateau(table: pd.DataFrame, weight: float) -> Row:
    """Row of the weight carried on the plateau: by the gas, a little by the walls, less the bed's inertia."""
    held = table[table["time_s"].between(RAMP, RAMP + HOLD)]
    times = held["time_s"].to_numpy()
    rising = np.gradient(held["mean_height_m"].to_numpy(), times)
    inertia = (rising[-1] - rising[0]) / (GRAVITY * (times[-1] - times[0]))
    walls = (held["weight_on_floor_1"] + held["weight_on_sides_1"]).mean()
    carried = held["pressure_drop_Pa"].mean() / weight + walls - inertia
    # at each moment, and not from end to end
    balance = held["pressure_drop_Pa"] / weight + held["weight_on_floor_1"] + held["weight_on_sides_1"]
    error = float(mean_error(balance.to_numpy() - np.gradient(rising, times) / GRAVITY))
    quantity = "pressure drop on the plateau, walls and inertia put right, over the weight per area [1]"
    source = f"weight {weight:.1f} Pa, of it floor and sides {walls:.3f}, inertia {inertia:.3f}"
    return Row(quantity, carried, 1, NEAR_WEIGHT, source, error)


def check(work: Path, solver: Path, figures: Path) -> list[Row]:
    """Rows and figure of the onset of fluidization, up and down, and of the plateau."""
    setup, table = ramped_bed(work, solver)
    of, frames = suspension(setup), read_frames(setup.folder)
    weight = NUMBER * of.weight / (WIDTH * DIAMETER)
    rows, curves = [], []
    for name, span, at_rest in (("up", UP, 0), ("down", DOWN, -1)):
        voidage = voidage_under_gas(frames, at_rest, table, of)
        reference = minimum_fluidization(of, voidage)
        onset, error = fitted_onset(table, span, weight, reference)
        quantity = f"minimum fluidization velocity, gas {name} [m/s]"
        rows.append(Row(quantity, onset, reference, NEAR, SOURCE.format(voidage), error))
        curves.append(curve_of(f"gas {name}", table, span, of, voidage))
    rows.append(plateau(table, weight))
    draw(figures / "fluidization", curves, "superficial velocity [m/s]", "pressure drop [Pa]")
    return rows
