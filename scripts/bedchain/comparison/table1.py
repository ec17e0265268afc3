# SPDX-License-Identifier: GPL-3.0-or-later
"""Table 1 of the paper beside the values of a case."""

from typing import Any

import pandas as pd

from bedchain.case.schema import Schema, schema_keys


def table_of_values(values: dict[str, Any], schema: Schema) -> pd.DataFrame:
    """Values of a case with their meanings and the paper's values.

    Parameters
    ----------
    values : dict
        Dotted key -> value.
    schema : dict
        The schema; ``x-paper`` is the value in the paper.

    Returns
    -------
    DataFrame
        key, value, paper_value (empty where the paper gives none), meaning (with unit and source).
    """
    parts = schema_keys(schema)
    rows = [
        {
            "key": key,
            "value": _text(values[key]),
            "paper_value": _text(part.get("x-paper", "")),
            "meaning": part["description"],
        }
        for key, part in parts.items()
        if key in values
    ]
    return pd.DataFrame(rows)


def _text(value: Any) -> str:
    if isinstance(value, list):
        return " ".join(map(str, value))
    return f"{value:.8g}" if isinstance(value, float) else str(value)
