# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of the chains by cell size and lag, with theory and noise: results/<case>/discussion.csv."""

from dataclasses import dataclass
from functools import lru_cache
from itertools import chain as joined
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy import special

from bedchain.chains import registry
from bedchain.chains.counting import count_moves
from bedchain.chains.registry import CaseChains
from bedchain.comparison.curves import curve_errors, curves_of
from bedchain.files import write_csv
from bedchain.measures.mixing import GROUPS, Splits
from bedchain.measures.numerical_dispersion import spreading
from bedchain.meter import keep_freed_memory
from bedchain.stage import run_stage
from bedchain.studies.scan import scan
from bedchain.trajectory.frames import Frames, Lag, Window, lag_frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import open_bed
from bedchain.trajectory.store import BedFiles
from bedchain.uncertainty.noise_floor import noise_floor

AXES = ("x", "z")
ROUND_OFF = 1e-6
Row = dict[str, Any]


@dataclass(frozen=True)
class Scanned:
    """Chains to run besides.

    Attributes
    ----------
    names : list of str
        Models.
    cell_sizes_m, lags_s : list of float
        Sizes of cells [m], rounded so that they divide the bed, and lags [s]; a lag that is no
        multiple of the frame interval, or does not divide both windows, is left out.
    """

    names: list[str]
    cell_sizes_m: list[float]
    lags_s: list[float]


def discuss_errors(
    bed: BedFiles, mixing: Path, discussion: Path, learning: Window, comparison: Window, splits: Splits,
    case: CaseChains, scanned: Scanned,
) -> None:  # fmt: skip
    """Learn and run chains of many grids and lags, and measure what theory says of them.

    The first of the models is run on every grid with every lag, the others with the case's own lag on every
    grid that is no finer (theirs take gigabytes) and on its own grid with every lag. Errors are against the
    mean of all realisations of the DEM.

    Parameters
    ----------
    bed : BedFiles
    mixing : Path
        ``mixing.csv``.
    discussion : Path
        Table to make: quantity, source, cell_m, lag_s, part, value, unit, ci_low, ci_high.
    learning, comparison : Window
    splits : Splits
    case : CaseChains
    scanned : Scanned
    """
    keep_freed_memory()
    run = open_bed(bed)
    learned, compared = (part.frames(run.times_s) for part in (learning, comparison))
    size, own_lag = (run.width_m, run.height_m), lag_frames(case.lag_s, run.interval_s)
    own_grid = case.flat_grid(*size)
    grids = [Grid(*size, *(max(1, round(length / cell)) for length in size)) for cell in scanned.cell_sizes_m]
    lags = [round(lag / run.interval_s) for lag in scanned.lags_s if is_whole(lag / run.interval_s)]
    lengths = [part.stop - part.start - 1 for part in (learned, compared)]
    lags = [lag for lag in lags if not any(length % lag for length in lengths)]
    curves = realisations(pd.read_csv(mixing), lengths[1] + 1)
    mean, in_memory = curves.mean(axis=0), lru_cache(maxsize=1)(lambda grid: run.frames(grid, learned))

    def measured(setting: tuple[Grid, int]) -> list[Row]:
        grid, lag = setting
        known, start = in_memory(grid), run.leading_to(grid, compared.start, lag)
        found = spreading_rows(known, grid, lag)
        single = count_moves(known.cells, grid.n_cells, lag)  # once for both models
        for name in scanned.names:
            coarser = grid.n_cells <= own_grid.n_cells
            if name == scanned.names[0] or own_grid == grid or (own_lag == lag and coarser):
                chain = registry.learn(name, known, grid, lag, case.estimator, single=single)
                remaining = chain.mixing(start, *splits, lengths[1] // lag)
                found += error_rows(name, grid, chain.lag_s, remaining, mean[::lag])
                found += signed_rows(name, grid, chain.lag_s, remaining, curves[:, ::lag])
        return found

    settings = list(product(dict.fromkeys([own_grid, *grids]), dict.fromkeys([own_lag, *lags])))
    found = scan(
        settings,
        measured,
        lambda setting: f"{setting[0].columns} x {setting[0].rows} cells, lag {setting[1]}",
        lambda rows: f"{len(rows)} numbers",
    )
    write_csv(pd.DataFrame([*floor_rows(curves), *joined.from_iterable(found)]), discussion)


def is_whole(number: float) -> bool:
    """Whether a ratio is a whole number up to round-off, at least 1."""
    return round(number) >= 1 and abs(number - round(number)) < ROUND_OFF


def realisations(table: pd.DataFrame, n_times: int) -> np.ndarray:
    """Curves of the DEM and of its repeats, (n_realisations, n_times, 4), the main run first."""
    names = [name for name in dict.fromkeys(table["source"]) if name == "dem" or name.startswith("dem_")]
    return np.stack([curves_of(table, name, n_times) for name in names])


def cell_size(grid: Grid) -> float:
    """Side of a square as large as a cell [m]."""
    return float(np.sqrt(grid.cell_width_m * grid.cell_height_m))


def floor_rows(curves: np.ndarray) -> list[Row]:
    """Number of realisations, and the noise floor of each group where there are repeats."""
    number = _row("realisations", "dem", np.nan, np.nan, "", len(curves), "1")
    if len(curves) < 2:
        return [number]
    floor, _ = noise_floor(curves[:, 1:])
    floors = zip(GROUPS, floor, strict=True)
    return [
        number,
        *(_row("noise_floor", "dem", np.nan, np.nan, group, value, "1") for (_, group), value in floors),
    ]


def error_rows(name: str, grid: Grid, lag_s: float, remaining: np.ndarray, dem: np.ndarray) -> list[Row]:
    """Signed (mean of chain - DEM) and rms error of each group."""
    errors = curve_errors(remaining, dem)
    return [
        _row(quantity, name, cell_size(grid), lag_s, group, errors[quantity][column], "1")
        for quantity in ("error_signed", "error_rms")
        for column, (_, group) in enumerate(GROUPS)
    ]


def signed_rows(name: str, grid: Grid, lag_s: float, remaining: np.ndarray, runs: np.ndarray) -> list[Row]:
    """Signed error of both groups of a direction together, with its 95 % interval by the runs of the DEM.

    A chain is the same for all runs: its errors against each scatter as the runs themselves (Student).
    """
    errors = np.array([curve_errors(remaining, run)["error_signed"] for run in runs])
    rows = []
    for direction in dict.fromkeys(direction for direction, _ in GROUPS):
        of_runs = errors[:, [at == direction for at, _ in GROUPS]].mean(axis=1)
        mean, half = of_runs.mean(), half_width(of_runs)
        ends = (mean - half, mean + half)
        rows.append(_row("error_signed", name, cell_size(grid), lag_s, direction, mean, "1", ends))
    return rows


def half_width(values: np.ndarray) -> float:
    """Half of the 95 % interval of a mean of independent values; NaN of a single one."""
    if len(values) < 2:
        return np.nan
    return float(special.stdtrit(len(values) - 1, 0.975) * values.std(ddof=1) / np.sqrt(len(values)))


def spreading_rows(frames: Frames, grid: Grid, lag: int) -> list[Row]:
    """Dispersion of particles and cells, and what averaging over cells should add."""
    lag_s = lag * frames.interval_s
    found = spreading(frames.x_m, frames.z_m, grid, Lag(lag, lag_s))
    return [
        _row(quantity, "dem", cell_size(grid), lag_s, axis, values[at], "m2/s")
        for quantity, values in zip(
            ("dispersion", "dispersion_of_cells", "dispersion_added"), found, strict=True
        )
        for at, axis in enumerate(AXES)
    ]


def _row(
    quantity: str, source: str, cell_m: float, lag_s: float, part: str, value: float, unit: str,
    interval: tuple[float, float] = (np.nan, np.nan),
) -> Row:  # fmt: skip
    return {
        "quantity": quantity, "source": source, "cell_m": cell_m, "lag_s": lag_s, "part": part,
        "value": float(value), "unit": unit, "ci_low": float(interval[0]), "ci_high": float(interval[1]),
    }  # fmt: skip


if rule := globals().get("snakemake"):
    run_stage(discuss_errors, rule)
