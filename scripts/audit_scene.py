# SPDX-License-Identifier: GPL-3.0-or-later
"""Physics that a case needs and what is built of it, from the case alone: results/<case>/audit.csv."""

from pathlib import Path

import pandas as pd

from bedchain.case.scene import scene_of
from bedchain.case.schema import Case
from bedchain.files import write_csv
from bedchain.stage import LOG, run_stage
from bedchain.studies.audit import audit
from bedchain.studies.expectation import audit_rows, expected_of, lines


def audit_scene(case: Case, table: Path) -> None:
    """Set the scene's dimensionless numbers against their thresholds, and say what follows.

    Parameters
    ----------
    case : dict
        The sections bed, particles, contact, gas and mixing of a checked case, and drum where it has one.
    table : Path
        Gets physics, number, symbol, value, threshold, source, decision, built, agrees; then, in the same
        columns, what to expect of a bed with gas (decision ``expect``).
    """
    scene = scene_of(case)
    rows = audit(scene)
    expected = expected_of(scene, case["mixing"]["split_z_m"])
    write_csv(pd.concat([rows, audit_rows(expected)], ignore_index=True), table)
    for row in rows.itertuples():
        LOG.info(
            "%s %s: %s %.3g, threshold %.3g", row.decision, row.physics, row.number, row.value, row.threshold
        )
    for row in rows[rows["agrees"] == "no"].itertuples():
        done = "is simulated and not needed" if row.built == "yes" else "is needed and not simulated"
        LOG.warning("warning: %s %s (%s = %.3g, %s)", row.physics, done, row.number, row.value, row.source)
    for line in lines(expected):
        LOG.info("%s", line)


if rule := globals().get("snakemake"):
    run_stage(audit_scene, rule)
