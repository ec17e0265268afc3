# SPDX-License-Identifier: GPL-3.0-or-later
"""Physics that a case needs and what is built of it, from the case alone: results/<case>/audit.csv."""

from pathlib import Path

from bedchain.case.scene import scene_of
from bedchain.case.schema import Case
from bedchain.files import write_csv
from bedchain.stage import LOG, run_stage
from bedchain.studies.audit import audit


def audit_scene(case: Case, table: Path) -> None:
    """Set the scene's dimensionless numbers against their thresholds, and say what follows.

    Parameters
    ----------
    case : dict
        The sections bed, particles, contact and gas of a checked case, and drum where it has one.
    table : Path
        Gets physics, number, symbol, value, threshold, source, decision, built, agrees.
    """
    rows = audit(scene_of(case))
    write_csv(rows, table)
    for row in rows.itertuples():
        LOG.info(
            "%s %s: %s %.3g, threshold %.3g", row.decision, row.physics, row.number, row.value, row.threshold
        )
    for row in rows[rows["agrees"] == "no"].itertuples():
        done = "is simulated and not needed" if row.built == "yes" else "is needed and not simulated"
        LOG.warning("warning: %s %s (%s = %.3g, %s)", row.physics, done, row.number, row.value, row.source)


if rule := globals().get("snakemake"):
    run_stage(audit_scene, rule)
