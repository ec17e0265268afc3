# SPDX-License-Identifier: GPL-3.0-or-later
"""Three settings chosen by what was measured: fast, balanced and accurate, by validation alone.

The errors that decide are those in parts of the learning window of chains learned on the rest of it. The
comparison window decides nothing; the errors found there are reported.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml
from numpy.typing import NDArray

from bedchain.errors import UserError
from bedchain.files import write_text
from bedchain.studies.pareto import pareto_front
from bedchain.studies.tradeoff.chain_settings import CELL_SIZES_M, FACTORIAL, ORDER, Own

NAMES = ("fast", "balanced", "accurate")
ERROR, COST = "validation_error_1", "cost_s"
# how large an error the fast one may have: in noise floors, and over the lowest of all
FAST_FLOORS, FAST_RATIO = 2.0, 1.5
SAME_COST = 1.25  # times of milliseconds that differ by less are the same: another run has them the other way
DIGITS = 3
HEADER = "# SPDX-License-Identifier: GPL-3.0-or-later\n# Chosen by `snakemake tradeoff`, which says how.\n"


def choose(table: pd.DataFrame, floor: float) -> dict[str, int]:
    """Rows of the three presets.

    ``accurate`` has the lowest validation error. ``fast`` is the cheapest whose validation error is within
    `FAST_FLOORS` noise floors or `FAST_RATIO` times the lowest, whichever allows more; of those that cost up
    to `SAME_COST` times as much, the one with the lowest validation error. ``balanced`` is the
    knee between the two: of those that nothing is both cheaper and more accurate than, the one furthest below
    the straight line from fast to accurate, in logarithms of cost and error; accurate where none is below.

    Parameters
    ----------
    table : DataFrame
        Rows of `chain_half.measure_all`.
    floor : float
        Noise floor of all mixing curves together [1]; NaN where unknown.

    Returns
    -------
    dict of str to int
        Index of the table, by name.

    Raises
    ------
    UserError
        No chain was validated.
    """
    valid = table[table["axis"].isin((FACTORIAL, ORDER)) & table[ERROR].notna()]
    if valid.empty:
        raise UserError("no chain could be validated: lengthen learning, or write frames more often")
    front = pareto_front(valid, COST, ERROR)
    accurate = front.index[-1]
    limit = np.nanmax([FAST_FLOORS * floor, FAST_RATIO * front[ERROR].iloc[-1]])
    cheapest = front.loc[front[ERROR] <= limit, COST].iloc[0]
    fast = front.index[front[COST] <= SAME_COST * cheapest][-1]
    between = front.loc[fast:accurate]
    return {"fast": int(fast), "balanced": int(between.index[knee(between)]), "accurate": int(accurate)}


def knee(front: pd.DataFrame) -> int:
    """Place of the row furthest below the chord of a front, in logarithms; the last where none is below."""
    cost, error = (_unit(np.log(front[name].to_numpy(float))) for name in (COST, ERROR))
    below = 1.0 - cost - error
    best = int(np.argmax(below)) if len(front) > 2 else len(front) - 1
    return best if below[best] > 0 else len(front) - 1


def write_presets(
    table: pd.DataFrame, chosen: dict[str, int], own: Own, measured_on: str, path: Path
) -> None:
    """Write the presets as ``cases/presets.yaml`` holds them.

    Parameters
    ----------
    table : DataFrame
        Rows of `chain_half.measure_all`.
    chosen : dict of str to int
        Of `choose`.
    own : Own
    measured_on : str
        Case and machine.
    path : Path
    """
    presets = {name: _preset(table.loc[row], own, measured_on) for name, row in chosen.items()}
    write_text(path, f"{HEADER}{yaml.safe_dump(presets, sort_keys=False)}")


def nominal_cell(columns: int, rows: int, own: Own) -> float:
    """Size of nearly square cells that stands for so many columns and rows [m]; see `Own.near`."""
    mean = float(np.sqrt(own.grid.width_m * own.grid.height_m / (columns * rows)))
    return next((size for size in (*CELL_SIZES_M, mean) if own.near(size) == (columns, rows)), mean)


def _preset(row: "pd.Series[Any]", own: Own, measured_on: str) -> dict[str, Any]:
    columns = round(own.grid.width_m / row["cell_width_m"])
    rows = round(own.grid.height_m / row["cell_height_m"])
    floors = {name: _rounded(float(row[f"{name}_floors_1"])) for name in ("mixing", "density")}
    return {
        "cell_m": float(f"{nominal_cell(columns, rows, own):.6g}"),
        "lag_s": float(f"{row['lag_s']:.6g}"),
        "model": str(row["model"]),
        "cost_s": _rounded(row[COST]),
        "error_floors": floors["mixing"],
        "density_floors": floors["density"],
        "measured_on": measured_on,
    }


def _rounded(value: float) -> float | None:
    return float(f"{value:.{DIGITS}g}") if np.isfinite(value) else None


def _unit(values: NDArray[np.float64]) -> NDArray[np.float64]:
    span = np.ptp(values)
    return (values - values.min()) / span if span > 0 else np.zeros_like(values)
