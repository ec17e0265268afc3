# SPDX-License-Identifier: GPL-3.0-or-later
"""What must come out of a case, cases/<case>/expected.csv, against what came out, metrics.csv."""

from pathlib import Path

import pandas as pd

from bedchain.errors import UserError

COLUMNS = ("quantity", "source", "value", "tolerance", "unit")


def read_expected(file: Path) -> pd.DataFrame:
    """Read the expected values of a case.

    Parameters
    ----------
    file : Path
        Columns quantity, source (as in ``metrics.csv``), value, tolerance (absolute, in the unit), unit;
        lines that start with ``#`` are comments.

    Returns
    -------
    DataFrame

    Raises
    ------
    UserError
        Where a line has too many fields, a column is missing, a row is there twice, or a tolerance is not
        positive.
    """
    try:
        table = pd.read_csv(file, comment="#", skipinitialspace=True, dtype={"unit": str})
    except pd.errors.ParserError as error:
        raise UserError(f"{file}: {str(error).strip()}; put a text with a comma into quotes") from None
    if missing := [name for name in COLUMNS if name not in table]:
        raise UserError(f"{file} lacks the columns {', '.join(missing)}; add them")
    if table.duplicated(["quantity", "source"]).any():
        twice = table[table.duplicated(["quantity", "source"])].iloc[0]
        raise UserError(f"{file}: {twice.quantity} of {twice.source} is there twice; keep one")
    if not (table.tolerance > 0).all():
        raise UserError(f"{file}: every tolerance must be positive; a value without one cannot be checked")
    return table


def deviations(expected: pd.DataFrame, metrics: pd.DataFrame) -> list[str]:
    """Differences between expected and measured values that exceed the tolerance.

    Parameters
    ----------
    expected : DataFrame
        Of `read_expected`.
    metrics : DataFrame
        Columns quantity, source, value, unit.

    Returns
    -------
    list of str
        One message for each row that is missing, in another unit, or off; empty where all is well.
    """
    found = expected.merge(metrics, "left", ["quantity", "source"], suffixes=("", "_found"), indicator="side")
    messages = []
    for row in found.itertuples():
        name = f"{row.quantity} of {row.source}"
        if row.side == "left_only":
            messages.append(f"{name} is missing")
        elif row.unit_found != row.unit:
            messages.append(f"{name} is in {row.unit_found}, expected in {row.unit}")
        elif not abs(row.value_found - row.value) <= row.tolerance:
            messages.append(
                f"{name} is {row.value_found:g} {row.unit}, expected {row.value:g} +- {row.tolerance:g}"
            )
    return messages
