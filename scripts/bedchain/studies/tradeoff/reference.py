# SPDX-License-Identifier: GPL-3.0-or-later
"""Observables of a simulated bed over the comparison window, and the reference from all realisations."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.case.cell_checks import not_flat
from bedchain.case.schema import Case
from bedchain.comparison.curves import curves_of
from bedchain.dem.series import read_series
from bedchain.errors import DataError
from bedchain.measures.batch import share_by_cell
from bedchain.measures.dispersion import dispersion_by_height
from bedchain.measures.mixing import Splits
from bedchain.studies.marked_starts import Start
from bedchain.studies.scan import observed_curves
from bedchain.studies.scores.predictions import SPAN_S
from bedchain.studies.tradeoff.observables import Reference
from bedchain.trajectory.frames import Lag
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import Realisation, part_of
from bedchain.uncertainty.deviations import stacked

Array = NDArray[np.float64]
# share of the difference between two groups at which they count as mixed
MIXED = float(np.exp(-1.0))


def splits_of(case: Case) -> Splits:
    """Lines between left and right, low and up [m]."""
    return Splits(**case["mixing"])


def compared(run: Realisation, case: Case) -> slice:
    """Frames of the comparison window."""
    return part_of(run, case["comparison"]["start_s"], case["comparison"]["end_s"])


def own_grid(run: Realisation, case: Case) -> Grid:
    """The case's cells on the bed of a run."""
    cells = case["cells"]
    if reason := not_flat(cells.get("form", "boxes"), cells.get("layers", 1), case.get("outside", "refuse")):
        raise DataError(f"{reason}: take a case of its own for this study")
    return Grid(run.width_m, run.height_m, cells["columns"], cells["rows"])


def window_curves(run: Realisation, case: Case) -> Array:
    """Mixing curves of a run over the comparison window, from the frame after its start, (n_frames, 4)."""
    which = compared(run, case)
    return observed_curves(run, Start(0, 0, which.start, which.stop - 1), splits_of(case))[1:]


def window_densities(run: Realisation, case: Case) -> Array:
    """Mean shares in the case's cells over either half of the comparison window, (2, n_cells)."""
    grid, which = own_grid(run, case), compared(run, case)
    half = which.start + 1 + (which.stop - 1 - which.start) // 2
    return np.stack(
        [
            np.mean([share_by_cell(grid.cell_of(*run.values[at, :2]), grid.n_cells) for at in part], axis=0)
            for part in (range(which.start + 1, half), range(half, which.stop))
        ]
    )


def window_scalars(run: Realisation, series: pd.DataFrame | None, case: Case) -> dict[str, float]:
    """Observables of the bed as a whole over the comparison window.

    Parameters
    ----------
    run : Realisation
    series : DataFrame or None
        ``bed_series.csv``; None where it is missing.
    case : Case

    Returns
    -------
    dict
        By the names of `observables.SCALARS`; without those of the gas where there is none, NaN for a
        mixing time after the end of the window.
    """
    which, grid = compared(run, case), own_grid(run, case)
    curves = np.vstack((np.ones(4), window_curves(run, case)))
    scalars = {
        "mixing_time_radial": mixing_time(curves[:, 0], curves[:, 1], run.interval_s),
        "mixing_time_axial": mixing_time(curves[:, 2], curves[:, 3], run.interval_s),
    }
    x, z, vx, vz = (run.values[which, row] for row in range(4))
    lag = max(1, min(round(SPAN_S / run.interval_s), len(x) - 1))
    layers = dispersion_by_height(x, z, grid.z_edges_m, Lag(lag, lag * run.interval_s))
    weights, filled = layers.displacements, layers.displacements > 0
    for column, axis in enumerate("xz"):
        values = layers.dispersion_m2_s[filled, column]
        scalars[f"dispersion_{axis}"] = float(np.average(values, weights=weights[filled]))
    if run.has_velocities:
        cells = np.stack([grid.cell_of(*places) for places in zip(x, z, strict=True)])
        scalars["granular_temperature"] = granular_temperature(cells, vx, vz, grid.n_cells)
    return scalars | ({} if series is None else series_scalars(series, case))


def series_scalars(series: pd.DataFrame, case: Case) -> dict[str, float]:
    """Mean height of the particles, pressure drop and its standard deviation over the comparison window."""
    part = series[series["time_s"].between(case["comparison"]["start_s"], case["comparison"]["end_s"])]
    scalars = {"bed_height": float(part["mean_height_m"].mean())}
    if "pressure_drop_Pa" in part:
        pressure = part["pressure_drop_Pa"]
        scalars |= {"pressure_drop": float(pressure.mean()), "pressure_drop_spread": float(pressure.std())}
    return scalars


def mixing_time(first: Array, second: Array, interval_s: float) -> float:
    """Time after which the difference between two groups, apart at the start, has fallen to 1/e [s].

    The difference is that of the groups' shares on the side of the first, ``first + second - 1``: 1 at the
    start, 0 once both are spread alike.

    Parameters
    ----------
    first, second : (n_frames,) array
        Share of each group that is still on its side, from the start on [1].
    interval_s : float
        Between frames [s].

    Returns
    -------
    float
        By a straight line between two frames; NaN where it never falls to 1/e.
    """
    apart = first + second - 1.0
    below = np.flatnonzero(apart <= MIXED)
    if not below.size or below[0] == 0:
        return float("nan")
    after = int(below[0])
    part = (apart[after - 1] - MIXED) / (apart[after - 1] - apart[after])
    return float((after - 1 + part) * interval_s)


def granular_temperature(
    cells: NDArray[np.int32], vx: NDArray[np.floating], vz: NDArray[np.floating], n_cells: int
) -> float:
    """Mean square of a component of the velocity about the mean of its cell and frame [m2/s2].

    Parameters
    ----------
    cells : (n_frames, n_particles) int array
    vx, vz : (n_frames, n_particles) array
        [m/s].
    n_cells : int

    Returns
    -------
    float
        Mean of the components x and z, weighted by the degrees of freedom of each cell (its particles less
        one); NaN where no cell holds two.
    """
    squares = freedom = 0.0
    for places, *velocity in zip(cells, vx, vz, strict=True):
        number = np.bincount(places, minlength=n_cells)
        freedom += float((number[number > 0] - 1).sum())
        for component in velocity:
            component = np.asarray(component, np.float64)
            total = np.bincount(places, component, n_cells)
            squares += float((component**2).sum() - (total**2 / np.maximum(number, 1)).sum())
    return squares / (2 * freedom) if freedom > 0 else float("nan")


def realisations(
    runs: Sequence[Realisation],
    series: Sequence[Path],
    mixing: Sequence[Path],
    case: Case,
    starts: Sequence[Start],
) -> Reference:
    """The reference of a case, from its run and repeats.

    Parameters
    ----------
    runs : sequence of Realisation
        The run, and those repeats whose positions are there.
    series : sequence of Path
        ``bed_series.csv`` of each of them.
    mixing : sequence of Path
        ``mixing.csv`` of all repeats; may be empty.
    case : Case
    starts : sequence of Start
        Of the run: without repeats each gives a curve, with repeats only the first.

    Returns
    -------
    Reference

    Raises
    ------
    UserError
        A repeat has other times, or a run lacks more than half of the window.
    """
    main, splits = runs[0], splits_of(case)
    curves = [observed_curves(main, start, splits)[1:] for start in starts]
    if mixing:
        n_times = len(curves[0]) + 1
        tables = [pd.read_csv(file) for file in mixing]
        curves = [
            curves[0], *(curves_of(table, table["source"].iloc[0], n_times)[1:] for table in tables)
        ]  # fmt: skip
    of_runs = [
        window_scalars(run, read_series(file), case) for run, file in zip(runs, series, strict=True)
    ]  # fmt: skip
    scalars = {name: tuple(of_run[name] for of_run in of_runs if name in of_run) for name in of_runs[0]}
    densities = np.stack([window_densities(run, case) for run in runs])
    return Reference(stacked(curves), bool(mixing), densities, scalars)
