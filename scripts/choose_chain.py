# SPDX-License-Identifier: GPL-3.0-or-later
"""The lag and the cells by rule, and what they rest on: results/<case>/choice.csv and choice_curve.csv."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from bedchain.files import write_csv
from bedchain.measures.choice import (
    AXES,
    REACHED,
    ChosenLag,
    choose_lag,
    correlation_times,
    raised,
)
from bedchain.measures.choice_of_cells import MOST_ADDED, ChosenCells, choose_cells
from bedchain.measures.dispersion_by_lag import DispersionByLag, dispersion_by_lag, thinned
from bedchain.measures.mixing import Splits
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.frames import Window
from bedchain.trajectory.realisations import open_realisation
from bedchain.trajectory.store import BedFiles
from bedchain.uncertainty.bands import block_band

DISPERSION = "particles' var(displacement) / (2 lag) at the chosen lag"
MEMORY = "correlation of successive displacements at the lag that the place does not explain"
Row = dict[str, Any]


def choose_chain(
    bed: BedFiles, choice: Path, curve: Path, learning: Window, splits: Splits, diameter_m: float
) -> None:
    """Choose the lag and the cells of a chain from the particles' dispersion in the learning window.

    Parameters
    ----------
    bed : BedFiles
    choice : Path
        Gets quantity, value, unit, why.
    curve : Path
        Gets the dispersion by lag with its 95 % band, and the share that cells add by their size: quantity,
        axis, lag_s, cell_m, value, unit, ci_low, ci_high.
    learning : Window
    splits : Splits
    diameter_m : float
        Of a particle [m].

    Raises
    ------
    DataError
        The particles are at rest or too few, the window holds fewer than three frames.
    """
    run = open_realisation("the run", bed.trajectory, bed.metadata)
    places = run.values[learning.frames(run.times_s)]
    x_m, z_m, size = thinned(places[:, 0]), thinned(places[:, 1]), (run.width_m, run.height_m)
    stays = np.isfinite(x_m).all(axis=0) & np.isfinite(z_m).all(axis=0)  # those that come and go have no lag
    x_m, z_m, number = x_m[:, stays], z_m[:, stays], round(places.shape[2] * stays.mean())
    dispersion = dispersion_by_lag(x_m, z_m, run.interval_s)
    lag = choose_lag(dispersion, number, diameter_m)
    lag = raised(lag, dispersion, np.stack((x_m, z_m)))
    cells = choose_cells((x_m, z_m), size, splits, diameter_m, lag.frames)
    rows = [*lag_rows(lag, dispersion), *cell_rows(cells, size), *basis_rows(lag, dispersion)]
    write_csv(pd.DataFrame(rows), choice)
    write_csv(pd.concat([dispersion_table(dispersion), added_table(cells, lag, dispersion)]), curve)
    LOG.info("lag %g s, %d x %d cells", lag.frames * run.interval_s, cells.columns, cells.rows)
    for remark in (*lag.doubts, cells.doubt, lag.remark):
        if remark:
            LOG.warning("choice: %s", remark)


def lag_rows(lag: ChosenLag, curve: DispersionByLag) -> list[Row]:
    """The lag, its range when a fifth of the window is left out, and that of each axis."""
    interval_s = curve.interval_s
    later = AXES[int(lag.on_axis.argmax())]
    why = f"first lag with {REACHED:.0%} of the largest dispersion on every axis; {later} reaches it last"
    reason = "; ".join(lag.doubts) or "; ".join(filter(None, (why, lag.remark)))
    low, high = (frames * interval_s for frames in lag.range)
    rows = [
        _row("lag_s", lag.frames * interval_s, "s", reason),
        _row("lag_low_s", low, "s", "least lag when one fifth of the window is left out in turn"),
        _row("lag_high_s", high, "s", "largest lag when one fifth of the window is left out in turn"),
    ]  # fmt: skip
    for axis, frames, top in zip(AXES, lag.on_axis, lag.maximum, strict=True):
        why = (
            f"first lag with {REACHED:.0%} of the largest dispersion along {axis}" if frames else "no motion"
        )
        rows.append(_row(f"lag_{axis}_s", frames * interval_s, "s", why))
        rows.append(
            _row(f"lag_of_maximum_{axis}_s", top * interval_s, "s", f"largest dispersion along {axis}")
        )
    return rows


def cell_rows(cells: ChosenCells, size_m: tuple[float, float]) -> list[Row]:
    """The cells and what they add to the dispersion."""
    width_m, height_m = size_m[0] / cells.columns, size_m[1] / cells.rows
    why = f"largest nearly square cells that add less than {MOST_ADDED:.0%} to the dispersion on every axis"
    return [
        _row("cell_m", float(np.sqrt(width_m * height_m)), "m", cells.doubt or why),
        _row("columns", cells.columns, "1", f"cells {width_m:.4g} m wide"),
        _row("rows", cells.rows, "1", f"cells {height_m:.4g} m high"),
        *(
            _row(f"added_{axis}_1", value, "1", "dispersion that the cells add, over the particles'")
            for axis, value in zip(AXES, cells.added, strict=True)
        ),
    ]


def basis_rows(lag: ChosenLag, curve: DispersionByLag) -> list[Row]:
    """The dispersion at the lag, the correlation times, the window."""
    place = int(np.searchsorted(curve.lags, lag.frames))
    times = correlation_times(curve)
    return [
        *(
            _row(f"dispersion_{axis}_m2_s", curve.coefficient_m2_s[place, at], "m2/s", DISPERSION)
            for at, axis in enumerate(AXES)
        ),
        *(
            _row(f"correlation_{axis}_s", times[at], "s", "largest dispersion over the velocity's variance")
            for at, axis in enumerate(AXES)
        ),
        *(_row(f"memory_{axis}_1", lag.memory[at], "1", MEMORY) for at, axis in enumerate(AXES)),
        _row("window_s", curve.window_s, "s", "learning window; lags up to half of it are looked at"),
        _row("interval_s", curve.interval_s, "s", "between frames: the shortest lag there is"),
    ]


def dispersion_table(curve: DispersionByLag) -> pd.DataFrame:
    """Dispersion by lag with its band, a row for each axis and lag."""
    low, high = block_band(curve.coefficient_m2_s, curve.left_out_m2_s, "positive")
    parts = [
        pd.DataFrame(
            {
                "quantity": "dispersion", "axis": axis, "lag_s": curve.lags_s, "cell_m": np.nan,
                "value": curve.coefficient_m2_s[:, at], "unit": "m2/s",
                "ci_low": low[:, at], "ci_high": high[:, at],
            }
        )
        for at, axis in enumerate(AXES)
    ]  # fmt: skip
    return pd.concat(parts, ignore_index=True)


def added_table(cells: ChosenCells, lag: ChosenLag, curve: DispersionByLag) -> pd.DataFrame:
    """Share that cells add to the dispersion by their size, a row for each size and axis."""
    lag_s = lag.frames * curve.interval_s
    shares = [
        (side, axis, share) for side, *both in cells.tried for axis, share in zip(AXES, both, strict=True)
    ]
    table = pd.DataFrame(shares, columns=["cell_m", "axis", "value"])
    return table.assign(quantity="added_share", lag_s=lag_s, unit="1")


def _row(quantity: str, value: float, unit: str, why: str) -> Row:
    return {"quantity": quantity, "value": float(value), "unit": unit, "why": why}


if rule := globals().get("snakemake"):
    run_stage(choose_chain, rule)
