# SPDX-License-Identifier: GPL-3.0-or-later
"""What the paper claims, cases/<case>/claims.csv, against what came out."""

from pathlib import Path

import pandas as pd

from bedchain.comparison.expected import read_expected
from bedchain.comparison.metrics import Metric, metric
from bedchain.errors import UserError

TEXTS = ("claim", "where", "why")
SECONDS_PER_HOUR = 3600.0


def read_claims(file: Path) -> pd.DataFrame:
    """Read the claims of a case.

    Parameters
    ----------
    file : Path
        Columns of `expected.read_expected`, and claim, where (in the paper), why (it holds, or not).

    Returns
    -------
    DataFrame

    Raises
    ------
    UserError
        As `expected.read_expected`.
    """
    table = read_expected(file)
    if missing := [name for name in TEXTS if name not in table or table[name].isna().any()]:
        raise UserError(f"{file}: each claim needs {', '.join(missing)}; add what is missing")
    return table


def agreement(claims: pd.DataFrame, metrics: pd.DataFrame) -> pd.DataFrame:
    """Each claim with its number, ours, and whether they agree.

    Parameters
    ----------
    claims : DataFrame
        Of `read_claims`.
    metrics : DataFrame
        quantity, source, value, unit.

    Returns
    -------
    DataFrame
        claim, where, quantity, source, paper, ours, unit, tolerance, within (yes or no), why.

    Raises
    ------
    UserError
        What a claim is about was not measured, or in another unit.
    """
    found = claims.merge(
        metrics.astype({"unit": str}), "left", ["quantity", "source", "unit"], suffixes=("", "_found")
    )
    if (lost := found["value_found"].isna()).any():
        row = found[lost].iloc[0]
        raise UserError(f"claim {row.claim!r}: no {row.quantity} of {row.source} in {row.unit} was measured")
    within = (found["value_found"] - found["value"]).abs() <= found["tolerance"]
    found = found.assign(within=within.map({True: "yes", False: "no"}))
    found = found.rename(columns={"value": "paper", "value_found": "ours"})
    columns = ["claim", "where", "quantity", "source", "paper", "ours", "unit", "tolerance", "within", "why"]
    return found[columns]


def swing_metrics(mixing: pd.DataFrame) -> list[Metric]:
    """How restless the curves of the chains are: the length of their ups and downs over that of the DEM's.

    Parameters
    ----------
    mixing : DataFrame
        Of mixing.csv.

    Returns
    -------
    list of dict
        swings_over_dem of each group and source; the DEM is looked at at the same times.
    """
    curves = {
        key: rows.set_index("time_s")["fraction_remaining_1"]
        for key, rows in mixing.groupby(["source", "group"], sort=False)
    }
    return [
        metric(
            f"swings_over_dem_{group}",
            str(source),
            curve.diff().abs().sum() / curves["dem", group].reindex(curve.index).diff().abs().sum(),
        )
        for (source, group), curve in curves.items()
        if source != "dem"
    ]


def cost_metrics(timing: pd.DataFrame, models: list[str]) -> list[Metric]:
    """Times of DEM and chains over the comparison window, and their ratios.

    Parameters
    ----------
    timing : DataFrame
        Of timing.csv.
    models : list of str

    Returns
    -------
    list of dict
        dem_time; for each model dem_over_chain_time (learned and run by Monte Carlo) and, but for the static
        one, <model>_over_static_time (of counts and matrix).
    """
    wall = timing.set_index("stage")["wall_s"]
    learned = {model: wall[f"{model}_count"] + wall[f"{model}_matrix"] for model in models}
    rows = [metric("dem_time", "dem", wall["dem"] / SECONDS_PER_HOUR, "h")]
    for model in models:
        run = learned[model] + wall[f"{model}_monte_carlo"]
        rows.append(metric("dem_over_chain_time", model, wall["dem"] / run))
        if model != "static" and "static" in models:
            rows.append(metric(f"{model}_over_static_time", model, learned[model] / learned["static"]))
    return rows
