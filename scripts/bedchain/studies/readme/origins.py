# SPDX-License-Identifier: GPL-3.0-or-later
"""The machine and the commit that a table's rows are from."""

import json
from pathlib import Path
from typing import Any

import pandas as pd

from bedchain.errors import UserError
from bedchain.provenance import git_state, machine

COMMIT_DIGITS = 12


def origin_of_case(results: Path) -> dict[str, str]:
    """Machine and commit of a case's results.

    Parameters
    ----------
    results : Path
        ``results/<case>``.

    Raises
    ------
    UserError
        There is no provenance.json.
    """
    file = results / "provenance.json"
    if not file.exists():
        raise UserError(f"there is no {file}: run the case first")
    record = json.loads(file.read_text(encoding="utf-8"))
    return _origin(record["machine"], record["git"])


def origin_now() -> dict[str, str]:
    """This machine and the commit that is checked out, for a study that has just run here."""
    return _origin(machine(), git_state())


def with_origin(table: pd.DataFrame, origin: dict[str, str]) -> pd.DataFrame:
    """A table with the columns machine and commit at its end."""
    return table.assign(**origin)


def _origin(computer: dict[str, Any], git: dict[str, Any]) -> dict[str, str]:
    commit = (git["commit"] or "unknown")[:COMMIT_DIGITS] + (" with changes" if git["dirty"] else "")
    return {"machine": f"{computer['processor']}, {computer['cores']} cores", "commit": commit}
