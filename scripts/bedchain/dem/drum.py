# SPDX-License-Identifier: GPL-3.0-or-later
"""Segments of a drum, simulated by LIGGGHTS alone; frames and records as of a bed with gas."""

import time
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from bedchain.dem.processes import longest_silence, run_deck
from bedchain.dem.restarts import complete
from bedchain.dem.segments import (
    DECKS,
    RESTART,
    SERIES,
    SegmentedRun,
    frame_columns,
    keep_own_frames,
    read_parameters,
)
from bedchain.trajectory.dumps import read_dump

FILL, TUMBLE, WALLS = "drum/in.fill", "drum/in.tumble", "drum/walls.in"
SERIES_COLUMNS = ["time_s", "mean_height_m", "surface_angle_rad", "kinetic_energy_J", "particles_1"]


def is_drum(case: Path) -> bool:
    """Whether ``results/<case>`` is a drum, by its ``parameters.lig``."""
    return "drum_speed" in read_parameters(case / "parameters.lig")


def input_files(case: Path, decks: Path) -> list[Path]:
    """Files that the run of a drum depends on, in a fixed order: parameters and decks."""
    blocks = [decks / "include" / name for name in ("style.in", "bed.in")]
    return [case / "parameters.lig", *(decks / name for name in (FILL, TUMBLE, WALLS)), *blocks]


def simulate(
    run: SegmentedRun,
    part: Path,
    steps: tuple[int, int],
    previous: Path,
    parameters: Mapping[str, float | str],
) -> tuple[float, float, float, float]:
    """Simulate one segment of a drum.

    Parameters
    ----------
    run : SegmentedRun
    part : Path
        Folder that gets its files, with ``bed_series.csv``.
    steps : (int, int)
        First and last step of the particles.
    previous : Path
        Folder with the restart to continue.
    parameters : mapping
        Of `bedchain.dem.segments.read_parameters`.

    Returns
    -------
    tuple of float
        Wall time, and its shares in particles, exchange and gas [s].

    Raises
    ------
    UserError
        LIGGGHTS is missing or stops: its last lines.
    """
    began = time.monotonic()
    variables = {
        "decks": DECKS, "parameters": run.case / "parameters.lig", "restart": previous / RESTART,
        "start_step": steps[0], "steps": steps[1] - steps[0], "output": part,
    }  # fmt: skip
    silence_s = longest_silence(float(parameters["frame_steps"]) * float(parameters["number"]))
    run_deck(DECKS / TUMBLE, variables, part / "liggghts.log", run.ranks, silence_s)
    with complete(part):
        keep_own_frames(part, run, steps, parameters)
    drum_series(part, parameters).to_csv(part / SERIES, index=False, float_format="%.10g")
    wall = time.monotonic() - began
    step_s = float(parameters["dem_step"])
    cost = wall / (step_s * (steps[1] - steps[0]))
    print(
        f"run_dem: {steps[1] * step_s:g} of {run.end_step * step_s:g} s simulated, "
        f"{cost:.1f} s per simulated second, {cost * (run.end_step - steps[1]) * step_s:.0f} s left",
        flush=True,
    )
    return wall, wall, 0.0, 0.0


def drum_series(folder: Path, parameters: Mapping[str, float | str]) -> pd.DataFrame:
    """Integral quantities of the bed in each frame of a segment.

    Parameters
    ----------
    folder : Path
        Holds the frames of the segment.
    parameters : dict
        Of `bedchain.dem.segments.read_parameters`.

    Returns
    -------
    DataFrame
        time_s, mean_height_m, surface_angle_rad, kinetic_energy_J (of translation), particles_1, in order of
        time. The angle is between the vertical and the radius to the centroid: that of a plane surface.
    """
    columns, rows = frame_columns(parameters), []
    radius, mass = float(parameters["width"]) / 2, particle_mass(parameters)
    for file in folder.glob(f"frame_*.{parameters['dump_suffix']}"):
        dump = read_dump(file, columns)
        x, z, vx, vz = (dump.values[:, columns.index(name)] for name in ("x", "z", "vx", "vz"))
        angle = np.arctan2(x.mean() - radius, radius - z.mean())
        energy = mass / 2 * float(np.sum(vx**2 + vz**2))
        rows.append((dump.step * float(parameters["dem_step"]), z.mean(), angle, energy, len(x)))
    return pd.DataFrame(sorted(rows), columns=SERIES_COLUMNS)


def particle_mass(parameters: Mapping[str, float | str]) -> float:
    """Mass of a particle [kg]."""
    return float(parameters["density"]) * np.pi / 6 * float(parameters["diameter"]) ** 3
