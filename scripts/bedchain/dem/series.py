# SPDX-License-Identifier: GPL-3.0-or-later
"""The time series of a whole bed, bed_series.csv."""

from pathlib import Path

import pandas as pd

from bedchain.errors import UserError

SERIES_COLUMNS = ("time_s", "mean_height_m")
FRAMES_COLUMNS = (*SERIES_COLUMNS, "particles_1")  # of imported frames
GAS_COLUMNS = (
    "pressure_drop_Pa",
    "smallest_voidage_1",
    "voidage_clips_1",
    "volume_balance_1",
    "exchange_error_1",
)


def read_series(path: Path) -> pd.DataFrame:
    """Time series of a whole bed, as the solver or the drum writes it.

    Parameters
    ----------
    path : Path
        ``bed_series.csv``.

    Returns
    -------
    DataFrame
        With the columns of `SERIES_COLUMNS` and, in a bed with gas, `GAS_COLUMNS`.

    Raises
    ------
    UserError
        The file cannot be read, or a column is missing.
    """
    try:
        whole = path.read_bytes().endswith(b"\n")
        table = pd.read_csv(path)
    except (OSError, ValueError) as error:
        raise UserError(f"{path}: not readable ({error}); run run_dem again") from error
    if not whole:
        raise UserError(f"{path} is cut off: its last line has no end; run run_dem again")
    without_gas = "surface_angle_rad" in table or tuple(table) == FRAMES_COLUMNS
    needed = SERIES_COLUMNS if without_gas else (*SERIES_COLUMNS, *GAS_COLUMNS)
    missing = [name for name in needed if name not in table]
    if missing:
        raise UserError(f"{path} has no column {', '.join(missing)}; run run_dem again")
    return table
