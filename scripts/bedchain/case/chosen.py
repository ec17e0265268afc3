# SPDX-License-Identifier: GPL-3.0-or-later
"""Lag and cells that a case leaves to choose_chain, the value auto, and those that it chose: choice.csv."""

import csv
from pathlib import Path
from typing import NamedTuple

from bedchain.case.schema import Case
from bedchain.errors import UserError, make_again

AUTO = "auto"


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


def is_auto(case: Case) -> bool:
    """Whether a case leaves its lag or its cells to choose_chain."""
    return AUTO in (case["chain"]["lag_s"], *(case["cells"][name] for name in ("columns", "rows")))


def with_choice(case: Case, file: Path | str) -> Case:
    """A case with the chosen numbers in the place of `AUTO`; one without any as it is, and no file is read.

    Parameters
    ----------
    case : dict
        A checked case.
    file : path
        ``choice.csv``.

    Returns
    -------
    dict

    Raises
    ------
    FileNotFoundError, UserError
        As `read_choice`.
    """
    if not is_auto(case):
        return case
    chosen = read_choice(file)._asdict()
    filled = {
        section: {name: chosen[name] if value == AUTO else value for name, value in case[section].items()}
        for section in ("cells", "chain")
    }
    return case | filled
