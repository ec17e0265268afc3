# SPDX-License-Identifier: GPL-3.0-or-later
"""The series of a bed as a whole, bed_series.csv, as the solvers write it."""

from pathlib import Path

import pandas as pd

from bedchain.errors import UserError

SERIES_COLUMNS = ("time_s", "mean_height_m")


GAS_COLUMNS = (
    "pressure_drop_Pa",
    "smallest_voidage_1",
    "voidage_clips_1",
    "volume_balance_1",
    "exchange_error_1",
)


def read_series(path: Path) -> pd.DataFrame:
    """What the solver wrote of the bed as a whole, step by step.

    Parameters
    ----------
    path : Path
        ``bed_series.csv``.

    Returns
    -------
    DataFrame
        With the columns of `SERIES_COLUMNS`, and where there is gas with those of `GAS_COLUMNS`.

    Raises
    ------
    UserError
        A column is missing.
    """
    try:
        table = pd.read_csv(path)
    except (OSError, ValueError) as error:
        raise UserError(f"{path}: not readable ({error}); run run_dem again") from error
    needed = SERIES_COLUMNS if "surface_angle_rad" in table else (*SERIES_COLUMNS, *GAS_COLUMNS)
    missing = [name for name in needed if name not in table]
    if missing:
        raise UserError(f"{path} has no column {', '.join(missing)}; run run_dem again")
    return table
