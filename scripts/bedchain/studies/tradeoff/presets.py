# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets: the settings fast, balanced and accurate, chosen by measured cost and validation error.

The validation error is that of chains learned on one part of the learning window, in the other part. The
comparison window decides nothing; errors there are reported only.
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
from bedchain.studies.tradeoff.chain_settings import CELL_SIZES_M, FACTORIAL, ORDER, CaseChain

ERROR, COST = "validation_error_1", "cost_s"
# largest error of the fast preset: in noise floors, and over the lowest error of all chains
FAST_FLOORS, FAST_RATIO = 2.0, 1.5
SAME_COST = 1.25  # times of milliseconds within this ratio count as the same: a second run may swap them
DIGITS = 3
HEADER = "# SPDX-License-Identifier: GPL-3.0-or-later\n# Chosen by `snakemake tradeoff`, which says how.\n"


def choose(table: pd.DataFrame, floor: float) -> dict[str, int]:
    """Rows of the three presets.

    ``accurate`` has the lowest validation error. ``fast`` is the cheapest whose validation error is within
    `FAST_FLOORS` noise floors or `FAST_RATIO` times the lowest, whichever is larger; of the chains that cost
    up to `SAME_COST` times as much, the most accurate. ``balanced`` is the knee between the two: the chain of
    the Pareto front furthest below the straight line from fast to accurate, in logarithms of cost and error;
    accurate where none is below.

    Parameters
    ----------
    table : DataFrame
        Rows of `measured_chains.measure_all`.
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
    """Number of the row furthest below the chord of a front, in logarithms; the last where none is below."""
    cost, error = (_unit(np.log(front[name].to_numpy(float))) for name in (COST, ERROR))
    below = 1.0 - cost - error
    best = int(np.argmax(below)) if len(front) > 2 else len(front) - 1
    return best if below[best] > 0 else len(front) - 1


def write_presets(
    table: pd.DataFrame, chosen: dict[str, int], base: CaseChain, measured_on: str, path: Path
) -> None:
    """Write the presets as ``cases/presets.yaml`` holds them.

    Parameters
    ----------
    table : DataFrame
        Rows of `measured_chains.measure_all`.
    chosen : dict of str to int
        Of `choose`.
    base : CaseChain
    measured_on : str
        Case and machine.
    path : Path
    """
    presets = {name: _preset(table.loc[row], base, measured_on) for name, row in chosen.items()}
    write_text(path, f"{HEADER}{yaml.safe_dump(presets, sort_keys=False)}")


def nominal_cell(columns: int, rows: int, base: CaseChain) -> float:
    """Size of nearly square cells that stands for so many columns and rows [m]; see `CaseChain.near`."""
    mean = float(np.sqrt(base.grid.width_m * base.grid.height_m / (columns * rows)))
    return next((size for size in (*CELL_SIZES_M, mean) if base.near(size) == (columns, rows)), mean)


def _preset(row: "pd.Series[Any]", base: CaseChain, measured_on: str) -> dict[str, Any]:
    columns = round(base.grid.width_m / row["cell_width_m"])
    rows = round(base.grid.height_m / row["cell_height_m"])
    floors = {name: _rounded(float(row[f"{name}_floors_1"])) for name in ("mixing", "density")}
    return {
        "cell_m": float(f"{nominal_cell(columns, rows, base):.6g}"),
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
