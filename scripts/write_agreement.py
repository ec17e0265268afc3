# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's claims beside what came out: results/<case>/agreement.csv."""

from pathlib import Path

import pandas as pd

from bedchain.comparison.claims import agreement, cost_metrics, read_claims, swing_metrics
from bedchain.files import write_csv
from bedchain.stage import LOG, stage


def write_agreement(
    claims: Path, metrics: Path, mixing: Path, timing: Path, target: Path, models: list[str]
) -> None:
    """Compare each claim with its measured number.

    Parameters
    ----------
    claims : Path
        ``cases/<case>/claims.csv``.
    metrics, mixing, timing : Path
        Tables of the case.
    target : Path
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
    table = agreement(read_claims(claims), pd.concat([measured, pd.DataFrame(further)]))
    write_csv(table, target)
    for row in table.itertuples():
        LOG.info("%-3s %s: %.3g, ours %.3g %s", row.within, row.claim, row.paper, row.ours, row.unit)


if "snakemake" in globals():
    with stage(snakemake.log[0]):
        write_agreement(
            Path(snakemake.input.claims),
            Path(snakemake.input.metrics),
            Path(snakemake.input.mixing),
            Path(snakemake.input.timing),
            Path(snakemake.output.agreement),
            snakemake.params.models,
        )
