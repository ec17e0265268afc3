# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of the chains by cell size and lag, with theory and noise: results/<case>/discussion.csv."""

from functools import lru_cache
from itertools import chain as joined
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from bedchain.chains import registry
from bedchain.comparison.curves import curve_errors, curves_of
from bedchain.files import write_csv
from bedchain.measures.mixing import GROUPS
from bedchain.measures.numerical_dispersion import spreading
from bedchain.stage import stage
from bedchain.studies.scan import scan
from bedchain.trajectory.frames import Frames, lag_frames, window
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import open_realisation
from bedchain.uncertainty.noise_floor import noise_floor

AXES = ("x", "z")
ROUND_OFF = 1e-6
Row = dict[str, Any]


def discuss_errors(
    trajectory: Path, metadata: Path, mixing: Path, discussion: Path,
    learning: dict[str, float], comparison: dict[str, float], split_x_m: float, split_z_m: float,
    columns: int, rows: int, lag_s: float, estimator: str, names: list[str],
    cell_sizes_m: list[float], lags_s: list[float],
) -> None:  # fmt: skip
    """Learn and run chains of many grids and lags, and measure what theory says of them.

    The first of the models is run on every grid with every lag, the others with the case's own lag on every
    grid that is no finer (theirs take gigabytes) and on its own grid with every lag. Errors are against the
    mean of all realisations of the DEM.

    Parameters
    ----------
    trajectory, metadata, mixing : Path
        ``trajectory.npy``, ``trajectory.json``, ``mixing.csv``.
    discussion : Path
        Table to make: quantity, source, cell_m, lag_s, part, value, unit.
    learning, comparison : dict of str to float
        start_s and end_s of each window [s].
    split_x_m, split_z_m : float
        Lines between left and right, low and up [m].
    columns, rows : int
        Of the case's own grid.
    lag_s : float
        Of the case's own chains [s].
    estimator : str
        How counts become probabilities.
    names : list of str
        Models.
    cell_sizes_m, lags_s : list of float
        Sizes of cells [m], rounded so that they divide the bed, and lags [s]; a lag that is no
        multiple of the frame interval, or does not divide both windows, is left out.
    """
    bed = open_realisation("the run", trajectory, metadata)
    learned, compared = (
        window(bed.times_s, part["start_s"], part["end_s"]) for part in (learning, comparison)
    )
    size, own_lag = (bed.width_m, bed.height_m), lag_frames(lag_s, bed.interval_s)
    own_grid = Grid(*size, columns, rows)
    grids = [Grid(*size, *(max(1, round(length / cell)) for length in size)) for cell in cell_sizes_m]
    lags = [round(lag / bed.interval_s) for lag in lags_s if is_whole(lag / bed.interval_s)]
    lengths = [part.stop - part.start - 1 for part in (learned, compared)]
    lags = [lag for lag in lags if not any(length % lag for length in lengths)]
    curves = realisations(pd.read_csv(mixing), lengths[1] + 1)
    mean, in_memory = curves.mean(axis=0), lru_cache(maxsize=1)(lambda grid: bed.frames(grid, learned))

    def measured(setting: tuple[Grid, int]) -> list[Row]:
        grid, lag = setting
        known, start = in_memory(grid), bed.leading_to(grid, compared.start, lag)
        found = spreading_rows(known, grid, lag)
        for name in names:
            coarser = grid.n_cells <= own_grid.n_cells
            if name == names[0] or own_grid == grid or (own_lag == lag and coarser):
                chain = registry.learn(name, known, grid, lag, estimator)
                remaining = chain.mixing(start, split_x_m, split_z_m, lengths[1] // lag)
                found += error_rows(name, grid, chain.lag_s, remaining, mean[::lag])
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
    """Noise floor of each group, where there are repeats."""
    if len(curves) < 2:
        return []
    floor, _ = noise_floor(curves[:, 1:])
    return [
        _row("noise_floor", "dem", np.nan, np.nan, group, value, "1")
        for (_, group), value in zip(GROUPS, floor, strict=True)
    ]


def error_rows(name: str, grid: Grid, lag_s: float, remaining: np.ndarray, dem: np.ndarray) -> list[Row]:
    """Signed (mean of chain - DEM) and rms error of each group."""
    errors = curve_errors(remaining, dem)
    return [
        _row(quantity, name, cell_size(grid), lag_s, group, errors[quantity][column], "1")
        for quantity in ("error_signed", "error_rms")
        for column, (_, group) in enumerate(GROUPS)
    ]


def spreading_rows(frames: Frames, grid: Grid, lag: int) -> list[Row]:
    """Dispersion of particles and cells, and what averaging over cells should add."""
    lag_s = lag * frames.interval_s
    found = spreading(frames.x_m, frames.z_m, grid, lag, lag_s)
    return [
        _row(quantity, "dem", cell_size(grid), lag_s, axis, values[at], "m2/s")
        for quantity, values in zip(
            ("dispersion", "dispersion_of_cells", "dispersion_added"), found, strict=True
        )
        for at, axis in enumerate(AXES)
    ]


def _row(quantity: str, source: str, cell_m: float, lag_s: float, part: str, value: float, unit: str) -> Row:
    return {
        "quantity": quantity, "source": source, "cell_m": cell_m, "lag_s": lag_s, "part": part,
        "value": float(value), "unit": unit,
    }  # fmt: skip


if "snakemake" in globals():
    with stage(snakemake.log[0]):
        discuss_errors(
            Path(snakemake.input.trajectory),
            Path(snakemake.input.metadata),
            Path(snakemake.input.mixing),
            Path(snakemake.output.discussion),
            snakemake.params.learning,
            snakemake.params.comparison,
            snakemake.params.split_x_m,
            snakemake.params.split_z_m,
            snakemake.params.columns,
            snakemake.params.rows,
            snakemake.params.lag_s,
            snakemake.params.estimator,
            snakemake.params.names,
            snakemake.params.cell_sizes_m,
            snakemake.params.lags_s,
        )
