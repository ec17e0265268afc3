# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's claims beside what came out: results/<case>/agreement.csv."""

from pathlib import Path

import pandas as pd

from bedchain.comparison.claims import agreement, cost_metrics, read_claims, swing_metrics
from bedchain.files import write_csv
from bedchain.stage import LOG, run_stage


def write_agreement(
    claims: Path, metrics: Path, mixing: Path, timing: Path, table: Path, models: list[str]
) -> None:
    """Compare each claim with its measured number.

    Parameters
    ----------
    claims : Path
        ``cases/<case>/claims.csv``.
    metrics, mixing, timing : Path
        Tables of the case.
    table : Path
        Table to make.
    models : list of str
        The case's chains.

    Raises
    ------
    UserError
        A claim lacks a number or a reason, or what it is about was not measured.
    """
    measured = pd.read_csv(metrics)
    further = swing_metrics(pd.read_csv(mixing)) + cost_metrics(pd.read_csv(timing), models)
    rows = agreement(read_claims(claims), pd.concat([measured, pd.DataFrame(further)]))
    write_csv(rows, table)
    for row in rows.itertuples():
        LOG.info("%-3s %s: %.3g, ours %.3g %s", row.within, row.claim, row.paper, row.ours, row.unit)


if rule := globals().get("snakemake"):
    run_stage(write_agreement, rule)
