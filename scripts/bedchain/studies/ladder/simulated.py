# SPDX-License-Identifier: GPL-3.0-or-later
"""The simulated bed as the truth of the ladder, with floors from parts of its run and from its repeats."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.case.parcels import parcel_case
from bedchain.case.schema import Case
from bedchain.measures.bubbles import followed_bubbles, middle_of_bed, voidage_maps
from bedchain.measures.mixing import GROUPS, Splits, remaining_from_positions
from bedchain.measures.spectrum import dominant_frequency
from bedchain.measures.voidage import Slab
from bedchain.studies.ladder.answers import Answer, Array, Truth, Values, distance, ladder_rows, of_density
from bedchain.studies.ladder.stays import stay_in_lower_part, stay_starts
from bedchain.studies.two_fluid_summary import piece_of
from bedchain.trajectory.frames import Window
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import Realisation
from bedchain.uncertainty.deviations import SIDES
from bedchain.uncertainty.noise_floor import floor_of

PARTS = 4  # of learning and comparison together: their spread gives the floors of means over a window


def values_of(run: Realisation, frames: slice, series: pd.DataFrame, grid: Grid, case: Case) -> Values:
    """Means of the simulated bed over frames, as of `answers.Answer`, without mixing."""
    positions, bed = run.values[frames], case["bed"]
    counts = np.zeros(grid.n_cells)
    for frame in positions:
        counts += np.bincount(grid.cell_of(frame[0], frame[1]), minlength=grid.n_cells)
    values = dict(of_density(counts / counts.sum(), grid, case))
    values["particle_height"] = float(np.mean(positions[:, 1]))
    start_s, end_s = run.times_s[frames][[0, -1]]
    within = series[series["time_s"].between(start_s, end_s)]
    values["pressure_drop"] = float(within["pressure_drop_Pa"].mean())
    peak = dominant_frequency(within["time_s"], within["pressure_drop_Pa"], piece_of(case))
    values["pressure_frequency"] = peak.frequency_hz
    cell_m, size = case["gas"]["cell_size_m"], (bed["height_m"], bed["width_m"])
    moved = parcel_case(case)
    slab = Slab(moved["bed"]["thickness_m"], moved["particles"]["diameter_m"])
    maps = voidage_maps(positions, size, cell_m, slab)
    table, risen = followed_bubbles(maps, cell_m, run.interval_s, bed["width_m"])
    bubbles = middle_of_bed(table, risen, 2 * float(values["particle_height"]))
    return values | {name.rsplit("_m", 1)[0]: value for name, value in bubbles.items()}


def truth_of(
    run: Realisation, spans: tuple[slice, slice], series: pd.DataFrame, curves: Array, grid: Grid, case: Case
) -> Truth:
    """The simulated bed over its comparison window.

    Parameters
    ----------
    run : Realisation
    spans : (slice, slice)
        Frames of learning and comparison.
    series : DataFrame
        ``bed_series.csv``.
    curves : (n_realisations, n_frames, 4) array
        Mixing curves of the run and its repeats, groups in the order of `GROUPS` [1].
    grid : Grid
        Cells of the case.
    case : dict

    Returns
    -------
    Truth
        Mixing curves are the mean of the realisations, their floor what one differs by from it. The other
        floors: what a mean over a window differs by, from the spread of `PARTS` parts of both windows.
    """
    values = dict(values_of(run, spans[1], series, grid, case))
    edges = np.linspace(spans[0].start, spans[1].stop, PARTS + 1).astype(int)
    parts = [values_of(run, slice(start, stop), series, grid, case) for start, stop in pairwise(edges)]
    floors = {}
    for name in values:
        mean = np.mean([np.asarray(part[name]) for part in parts], axis=0)
        spread = [distance(name, part[name], mean) for part in parts]
        # a window is half of the parts: of its mean the variance is that of a part over PARTS / 2
        floors[name] = float(np.sqrt(np.sum(np.square(spread)) / (PARTS - 1) / (PARTS / 2)))
    # a peak is not known better than by half of the distance of two frequencies
    half = 1 / piece_of(case) / 2 / float(values["pressure_frequency"])
    floors["pressure_frequency"] = max(floors["pressure_frequency"], half)
    values["stay_low"], floors["stay_low"] = stays_of(run, spans, case)
    for direction in ("radial", "axial"):
        of_direction = curves[..., SIDES[direction]]
        values[f"mixing_{direction}"] = of_direction.mean(axis=0)
        if len(curves) > 1:
            floors[f"mixing_{direction}"] = floor_of(of_direction[:, 1:])
    return Truth(values, floors, run.interval_s)


def bed_answer(model: str, run: Realisation, series: pd.DataFrame, cost_s: float, case: Case) -> Answer:
    """What another simulation of the bed says over its comparison window.

    Parameters
    ----------
    model : str
        Its name.
    run : Realisation
    series : DataFrame
        ``bed_series.csv``.
    cost_s : float
        Processor time for a simulated second [s].
    case : dict
        Its case, with cells and windows of the bed that it is compared with.
    """
    windows = [Window(case[name]["start_s"], case[name]["end_s"]) for name in ("learning", "comparison")]
    spans = windows[0].frames(run.times_s), windows[1].frames(run.times_s)
    grid = Grid(run.width_m, run.height_m, case["cells"]["columns"], case["cells"]["rows"])
    values = dict(values_of(run, spans[1], series, grid, case))
    values["stay_low"] = stays_of(run, spans, case)[0]
    x_m, z_m = (run.values[spans[1], axis] for axis in (0, 1))
    curves = remaining_from_positions(x_m, z_m, *Splits(**case["mixing"]))
    for direction in ("radial", "axial"):
        values[f"mixing_{direction}"] = curves[:, SIDES[direction]]
    return Answer(model, values, cost_s, lag_s=run.interval_s, paths=True)


def stays_of(run: Realisation, spans: tuple[slice, slice], case: Case) -> tuple[float, float]:
    """Stay in the lower part over the comparison [s], and what such a mean differs by [1]."""
    starts, horizon = stay_starts(*spans)
    pieces = (run.values[start : start + horizon + 1, 1] for start in starts)
    line_m, interval_s = case["mixing"]["split_z_m"], run.interval_s
    stays = [stay_in_lower_part(piece, interval_s, line_m, horizon * interval_s) for piece in pieces]
    return float(np.mean(stays[-2:])), float(np.std(stays, ddof=1) / np.mean(stays) / np.sqrt(2))


def dem_rows(truth: Truth, cost_s: float, memory_mb: float = np.nan) -> pd.DataFrame:
    """Rows of the simulation itself: another realisation has an error of a floor in each quantity."""
    values = {name: true for name, true in truth.values.items() if name in truth.floors}
    answer = Answer(
        "bedFoam", values, cost_s, memory_mb=memory_mb, lag_s=truth.interval_s, paths=True,
        note="memory as estimated for a run",
    )  # fmt: skip
    rows = ladder_rows([answer], truth)
    of_floor = rows["noise_floor_1"].notna()
    rows.loc[of_floor, "error_1"], rows.loc[of_floor, "error_floors"] = rows["noise_floor_1"], 1.0
    return rows


def read_curves(mixing: Path) -> NDArray[np.float64]:
    """Mixing curves of all realisations in ``mixing.csv``, (n_realisations, n_frames, 4)."""
    table = pd.read_csv(mixing)
    table = table[table["source"].str.fullmatch(r"dem(_\d+)?")]
    wide = table.pivot_table(index=["source", "time_s"], columns="group", values="fraction_remaining_1")
    wide = wide[[group for _, group in GROUPS]]
    return np.array([part.to_numpy() for _, part in wide.groupby(level="source")])
