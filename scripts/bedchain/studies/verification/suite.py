# SPDX-License-Identifier: GPL-3.0-or-later
"""All checks of the solvers, by name."""

import time
from collections.abc import Callable, Iterable
from pathlib import Path

import pandas as pd

from bedchain.errors import UserError
from bedchain.files import write_csv
from bedchain.studies.verification import (
    conservation,
    contacts,
    convergence,
    fluidization,
    parcels,
    settled_bed,
    settling,
    suspension,
    thickness,
    uniform_bed,
)
from bedchain.studies.verification.rows import Row, table_of

Check = Callable[[Path, Path, Path], list[Row]]
CHECKS: dict[str, Check] = {
    "contacts": contacts.check,
    "settling": settling.check,
    "suspension": suspension.check,
    "uniform_bed": uniform_bed.check,
    "settled_bed": settled_bed.check,
    "fluidization": fluidization.check,
    "thickness": thickness.check,
    "conservation": conservation.check,
    "convergence": convergence.check,
    "parcels": parcels.check,
}


def verify(
    solver: Path, folder: Path, only: Iterable[str] = (), say: Callable[[str], None] = print
) -> pd.DataFrame:
    """Run the checks and write ``verification.csv`` and ``figures/``.

    Parameters
    ----------
    solver : Path
        bedFoam.
    folder : Path
        Gets the table, the figures and ``work/`` with all cases.
    only : iterable of str
        Names of checks; empty for all.
    say : callable
        Called with a line for each check.

    Returns
    -------
    DataFrame
        A row for each checked quantity.

    Raises
    ------
    UserError
        Unknown check, or no solver.
    """
    names = list(only) or list(CHECKS)
    if unknown := sorted(set(names) - set(CHECKS)):
        raise UserError(f"there is no check {', '.join(unknown)}: take one of {', '.join(CHECKS)}")
    if not solver.exists():
        raise UserError(f"there is no solver {solver}: run snakemake build_solver")
    rows: list[Row] = []
    for name in names:
        start = time.monotonic()
        of_check = CHECKS[name](folder / "work", solver, folder / "figures")
        passed = sum(row.passed for row in of_check)
        say(f"{name}: {passed} of {len(of_check)} rows pass, {time.monotonic() - start:.0f} s")
        rows += of_check
    table = table_of(rows)
    write_csv(table, folder / "verification.csv")
    return table
