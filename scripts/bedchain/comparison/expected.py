# SPDX-License-Identifier: GPL-3.0-or-later
"""Expected values of a case, cases/<case>/expected.csv, beside the measured values of metrics.csv."""

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
        The file cannot be read, a line has too many fields, a column is missing, a row is there twice, or a
        tolerance is not positive.
    """
    try:
        table = pd.read_csv(file, comment="#", skipinitialspace=True, dtype={"unit": str})
    except (OSError, ValueError) as error:
        raise UserError(f"{file}: {str(error).strip()}; put texts with a comma into quotes") from None
    if missing := [name for name in COLUMNS if name not in table]:
        raise UserError(f"{file} lacks the columns {', '.join(missing)}; add them")
    if table.duplicated(["quantity", "source"]).any():
        twice = table[table.duplicated(["quantity", "source"])].iloc[0]
        raise UserError(f"{file}: {twice.quantity} of {twice.source} is there twice; keep one")
    numbers = {name: pd.to_numeric(table[name], errors="coerce") for name in ("value", "tolerance")}
    if any(column.isna().any() for column in numbers.values()):
        raise UserError(f"{file}: a value or a tolerance is no number; correct it")
    table = table.assign(**numbers)
    if not (table.tolerance > 0).all():
        raise UserError(f"{file}: a tolerance is not positive; give each value a positive one")
    return table


def with_measured(expected: pd.DataFrame, metrics: pd.DataFrame) -> pd.DataFrame:
    """Expected values with the measured values beside them.

    Parameters
    ----------
    expected : DataFrame
        From `read_expected`.
    metrics : DataFrame
        Columns quantity, source, value, unit.

    Returns
    -------
    DataFrame
        Columns of ``expected``, and measured (NaN where the value, in this unit, is missing) and within (True
        if it is within the tolerance).
    """
    measured = metrics.rename(columns={"value": "measured"}).astype({"unit": str})
    key = ["quantity", "source", "unit"]
    table = expected.merge(measured[[*key, "measured"]], "left", key)
    return table.assign(within=(table["measured"] - table["value"]).abs() <= table["tolerance"])


def deviations(expected: pd.DataFrame, metrics: pd.DataFrame) -> list[str]:
    """Messages about measured values that are not within the tolerance, or missing (nan).

    Parameters
    ----------
    expected, metrics : DataFrame
        As `with_measured`.
    """
    table = with_measured(expected, metrics)
    return [
        f"{row.quantity} of {row.source} [{row.unit}] is {row.measured:g}, "
        f"expected {row.value:g} +- {row.tolerance:g}"
        for row in table[~table["within"]].itertuples()
    ]
