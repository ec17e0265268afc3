# SPDX-License-Identifier: GPL-3.0-or-later
"""Table 1: the values that set a bed and its chains; in the paper's bed, the paper's beside them."""

from typing import Any, NamedTuple

import pandas as pd

from bedchain.case.schema import Schema, schema_keys


class Row(NamedTuple):
    """A row: what it is, its unit, the keys whose values it joins, and how."""

    parameter: str
    unit: str
    keys: tuple[str, ...]
    joint: str = ""


ROWS = (
    Row("bed, width x height", "m", ("bed.width_m", "bed.height_m"), " x "),
    Row("bed, depth between the walls", "m", ("bed.thickness_m",)),
    Row("time of a revolution", "s", ("drum.revolution_s",)),
    Row("particles", "1", ("particles.number",)),
    Row("particle diameter", "m", ("particles.diameter_m",)),
    Row("particle density", "kg/m3", ("particles.density_kg_m3",)),
    Row("Young's modulus", "Pa", ("contact.young_modulus_Pa",)),
    Row("coefficient of restitution", "1", ("contact.restitution_1",)),
    Row("sliding friction", "1", ("contact.friction_1",)),
    Row("gas velocity over the empty section", "m/s", ("gas.superficial_velocity_m_s",)),
    Row("drag law", "name", ("gas.drag_law",)),
    Row("gas cell", "m", ("gas.cell_size_m",)),
    Row("step of the particles", "s", ("time.dem_step_s",)),
    Row("chains learned from", "s", ("learning.start_s", "learning.end_s"), " to "),
    Row("chains compared over", "s", ("comparison.start_s", "comparison.end_s"), " to "),
    Row("cells of the chains, columns x rows", "1", ("cells.columns", "cells.rows"), " x "),
    Row("lag of a chain", "s", ("chain.lag_s",)),
)
NOT_GIVEN = "not given"


def table_of_values(values: dict[str, Any], schema: Schema, with_paper: bool) -> pd.DataFrame:
    """Values of a case, each with its unit.

    Parameters
    ----------
    values : dict
        Dotted key -> value; rows without all their keys are left out.
    schema : dict
        The schema; ``x-paper`` is the value in the paper.
    with_paper : bool
        Whether the paper's values stand beside the case's.

    Returns
    -------
    DataFrame
        parameter, paper (if asked for), this_case, unit, key.
    """
    parts, rows = schema_keys(schema), []
    for row in ROWS:
        if not {*row.keys} <= {*values} or (
            row.keys == ("bed.thickness_m",) and values.get("bed.layers") == "one"
        ):
            continue
        papers = [parts[key].get("x-paper") for key in row.keys]
        paper = NOT_GIVEN if None in papers else row.joint.join(map(_text, papers))
        this_case = row.joint.join(_text(values[key]) for key in row.keys)
        rows.append((row.parameter, paper, this_case, row.unit, " ".join(row.keys)))
    table = pd.DataFrame(rows, columns=["parameter", "paper", "this_case", "unit", "key"])
    return table if with_paper else table.drop(columns="paper")


def _text(value: Any) -> str:
    return f"{value:.8g}" if isinstance(value, float) else str(value)
