# SPDX-License-Identifier: GPL-3.0-or-later
"""Claims of the paper, cases/<case>/claims.csv, beside the measured values."""

from pathlib import Path

import pandas as pd

from bedchain.comparison.expected import read_expected, with_measured
from bedchain.comparison.metrics import Metric, metric
from bedchain.errors import UserError

TEXTS = ("claim", "where", "why")
SECONDS_PER_HOUR = 3600.0


def read_claims(file: Path) -> pd.DataFrame:
    """Read the claims of a case.

    Parameters
    ----------
    file : Path
        Columns of `expected.read_expected`, and claim, where (in the paper), why (the reason of the result).

    Returns
    -------
    DataFrame

    Raises
    ------
    UserError
        As `expected.read_expected`, or a claim lacks a text.
    """
    table = read_expected(file)
    if missing := [name for name in TEXTS if name not in table or table[name].isna().any()]:
        raise UserError(f"{file}: each claim needs {', '.join(missing)}; add the missing texts")
    return table


def agreement(claims: pd.DataFrame, metrics: pd.DataFrame) -> pd.DataFrame:
    """Each claim with the paper's number and ours, and their agreement.

    Parameters
    ----------
    claims : DataFrame
        From `read_claims`.
    metrics : DataFrame
        quantity, source, value, unit.

    Returns
    -------
    DataFrame
        claim, where, quantity, source, paper, ours, unit, tolerance, within (yes or no), why.

    Raises
    ------
    UserError
        The quantity of a claim was not measured, or in another unit.
    """
    table = with_measured(claims, metrics)
    if (missing := table["measured"].isna()).any():
        row = table[missing].iloc[0]
        raise UserError(f"claim {row.claim!r}: no {row.quantity} of {row.source} in {row.unit} was measured")
    table["within"] = table["within"].map({True: "yes", False: "no"})
    columns = ["claim", "where", "quantity", "source", "paper", "ours", "unit", "tolerance", "within", "why"]
    return table.rename(columns={"value": "paper", "measured": "ours"})[columns]


def swing_metrics(mixing: pd.DataFrame) -> list[Metric]:
    """Sum of the absolute changes of each chain's curve, over that of the DEM's curve.

    Parameters
    ----------
    mixing : DataFrame
        Of mixing.csv.

    Returns
    -------
    list of dict
        swings_over_dem of each group and source; the DEM's curve is taken at the times of the chain's.
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
        dem_time; for each model dem_over_chain_time (learning and a Monte Carlo run) and, except for the
        static model, <model>_over_static_time (counts and matrix).
    """
    wall = timing.set_index("stage")["wall_s"]
    learning = {model: wall[f"{model}_count"] + wall[f"{model}_matrix"] for model in models}
    rows = [metric("dem_time", "dem", wall["dem"] / SECONDS_PER_HOUR, "h")]
    for model in models:
        chain = learning[model] + wall[f"{model}_monte_carlo"]
        rows.append(metric("dem_over_chain_time", model, wall["dem"] / chain))
        if model != "static" and "static" in models:
            rows.append(metric(f"{model}_over_static_time", model, learning[model] / learning["static"]))
    return rows
