# SPDX-License-Identifier: GPL-3.0-or-later
"""Watch over a two-fluid run: the solids' mass, their packing limit, and progress."""

import math
import re
import time
from pathlib import Path

import numpy as np
import pandas as pd

from bedchain.case.schema import Case
from bedchain.dem.gas_case import last_time
from bedchain.dem.processes import show_progress
from bedchain.dem.two_fluid_fields import read_frame, read_vectors
from bedchain.dem.two_fluid_start import grid_of, largest_solids, start_solids
from bedchain.errors import UserError
from bedchain.meter import children_peak_mb

DRIFT_MAX = 1e-3  # of the solids' mass: the run stops
TIME = re.compile(r"^Time = (\S+)")
EXECUTION = re.compile(r"ExecutionTime = (\S+) s")


def drift_of(gas: Path, case: Case, lost_kg: float) -> tuple[pd.DataFrame, float]:
    """What solids in the bed and those that left sum to, over those at the start, less 1; and what left [kg].

    Parameters
    ----------
    gas : Path
        OpenFOAM case of a segment.
    case : dict
    lost_kg : float
        Solids that left before [kg].

    Returns
    -------
    DataFrame
        time_s, drift [1].
    float
        Solids that left in the segment [kg].
    """
    particles = case["particles"]
    whole = particles["density_kg_m3"] * particles["number"] * math.pi / 6 * particles["diameter_m"] ** 3
    mass, left = read_series(gas, "solids"), read_series(gas, "left")
    out = (left["value"] * case["time"]["gas_step_s"]).cumsum()
    until = np.interp(mass["time_s"], left["time_s"], out, left=0.0)
    inside = mass["value"] / start_solids(case).mean()
    drift = inside + (lost_kg + until) / whole - 1
    return pd.DataFrame({"time_s": mass["time_s"], "drift": drift}), float(out.iloc[-1])


def check_solids(gas: Path, case: Case, span: tuple[float, float], lost_kg: float = 0.0) -> float:
    """Refuse (`UserError`) a segment whose solids drifted or passed their packing limit: time and place.

    What leaves at the top is no drift; it is given back [kg].
    """
    mass, lost = drift_of(gas, case, lost_kg)
    drift = mass["drift"]
    if (far := drift.abs() > DRIFT_MAX).any():
        at = int(np.flatnonzero(far)[0])
        raise UserError(
            f"at {mass['time_s'].iloc[at]:g} s the solids' mass is {drift.iloc[at]:+.2%} off, more than "
            f"{DRIFT_MAX:.1%}: take a smaller time.gas_step_s"
        )
    limit, largest = largest_solids(case), read_series(gas, "largest")
    if (over := largest["value"] > limit).any():
        at = int(np.flatnonzero(over)[0])
        grid, last = grid_of(case), last_time(gas)
        assert last is not None
        solids = read_frame(last, grid.rows, grid.columns, 1.0)[0]
        row, column = np.unravel_index(int(solids.argmax()), solids.shape)
        place = f"x {grid.cell_width_m * (column + 0.5):.3g} m, z {grid.cell_height_m * (row + 0.5):.3g} m"
        raise UserError(
            f"at {largest['time_s'].iloc[at]:g} s a cell has {largest['value'].iloc[at]:.3f} of solids, over "
            f"the packing limit {limit:g} (densest at {span[1]:g} s: {place}): take a smaller time.gas_step_s"
        )
    return lost


def fastest_place(gas: Path, case: Case) -> str:
    """Where the solids of the last frame are fastest, as part of a message; empty before the first."""
    grid, last = grid_of(case), last_time(gas)
    if last is None or not (last / "U.particles").exists():
        return ""
    speed = np.linalg.norm(read_vectors(last / "U.particles", grid.n_cells), axis=1)
    speed = np.where(np.isfinite(speed), speed, np.inf)
    x, z = grid.centres_m[at := int(speed.argmax())]
    return f" (fastest solids at {last.name} s: {speed[at]:.3g} m/s, x {x:.3g} m, z {z:.3g} m)"


def read_series(gas: Path, name: str) -> pd.DataFrame:
    """Series of a function of the solver, (time_s, value)."""
    (file,) = (gas / "postProcessing" / name).glob("*/*.dat")
    return pd.read_csv(file, sep=r"\s+", comment="#", names=["time_s", "value"])


class Progress:
    """Progress of the solver on stderr every few seconds.

    Parameters
    ----------
    end_s : float
        Simulated time at the end of the whole run [s].
    start_s : float
        Simulated time at the start of the segment [s].
    """

    EVERY_S = 10.0

    def __init__(self, end_s: float, start_s: float) -> None:
        self.end_s, self.start_s, self.now_s, self.cpu_s = end_s, start_s, start_s, 0.0
        self.memory_mb = 0.0
        self.began = self.last = time.monotonic()

    def __call__(self, line: str) -> None:
        """Take one line of the solver's output."""
        if match := EXECUTION.search(line):
            self.cpu_s = float(match[1])
        if not (match := TIME.match(line)):
            return
        self.now_s = float(match[1])
        now = time.monotonic()
        due = now - self.last >= self.EVERY_S
        if due or not self.memory_mb:
            self.memory_mb = max(self.memory_mb, children_peak_mb())
        if not due:
            return
        self.last = now
        cost = (now - self.began) / max(self.now_s - self.start_s, 1e-9)
        show_progress("two_fluid", self.now_s, self.end_s, cost)
