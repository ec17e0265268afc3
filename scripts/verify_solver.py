# SPDX-License-Identifier: GPL-3.0-or-later
"""Check the solvers against theory, on small cases; write results/verify/verification.csv and figures.

usage: python scripts/verify_solver.py
       python scripts/verify_solver.py --only settling suspension --solver OTHER/bedFoam --folder /tmp/verify

It ends with code 1 where a row does not pass, after the whole table is printed.
"""

import argparse
import sys
from pathlib import Path

import pandas as pd

from bedchain.errors import report_user_errors
from bedchain.lifetime import end_with_run
from bedchain.studies.verification.suite import CHECKS, verify

SOLVER = Path("results/bin/bedFoam")
FOLDER = Path("results/verify")


def printed(table: pd.DataFrame) -> str:
    """The table for people: one line a row, without the sources."""
    shown = table.drop(columns="source")
    digits = dict.fromkeys(("value", "error", "reference", "tolerance"), "{:.5g}".format)
    return shown.to_string(index=False, formatters=digits, justify="left", na_rep="")


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME", help=f"of {', '.join(CHECKS)}")
    parser.add_argument("--solver", type=Path, default=SOLVER, help=f"bedFoam (default {SOLVER})")
    parser.add_argument("--folder", type=Path, default=FOLDER, help=f"for all results (default {FOLDER})")
    arguments = parser.parse_args()
    end_with_run()
    with report_user_errors():
        table = verify(
            arguments.solver, arguments.folder, arguments.only, lambda line: print(line, flush=True)
        )
    print(printed(table))
    failed = int((table["pass"] == "no").sum())  # noqa: S105
    print(f"{len(table) - failed} of {len(table)} rows pass")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
