# SPDX-License-Identifier: GPL-3.0-or-later
"""The lag and the cells that choose_chain chose: reading of choice.csv."""

import csv
from pathlib import Path
from typing import NamedTuple

from bedchain.errors import UserError, make_again


class Chosen(NamedTuple):
    """Lag and cells by rule.

    Attributes
    ----------
    lag_s : float
        Time of a step [s].
    columns, rows : int
        Cells along the width and the height [1].
    """

    lag_s: float
    columns: int
    rows: int


def read_choice(file: Path | str) -> Chosen:
    """Lag and cells of a ``choice.csv``.

    Parameters
    ----------
    file : path

    Returns
    -------
    Chosen

    Raises
    ------
    FileNotFoundError
        It is not there yet.
    UserError
        It lacks a row, or a value is no number.
    """
    with Path(file).open(encoding="utf-8", newline="") as stream:
        values = {row.get("quantity"): row.get("value") for row in csv.DictReader(stream)}
    try:
        lag_s, columns, rows = (float(values[name] or "") for name in Chosen._fields)
        return Chosen(lag_s, int(columns), int(rows))
    except (KeyError, ValueError) as error:
        raise UserError(f"{file} gives no {', '.join(Chosen._fields)}; {make_again(file)}") from error
