# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulate one variant of a case's bed for the trade-off study, on one rank, in restartable segments.

usage: python scripts/run_variant.py cases/short/case.yaml results/short/tradeoff/friction_0

The folder's name is that of the variant. It gets what results/<case> of a simulated case holds, and
variant.json: the solvers' peak memory, or the error that stopped them, which is a result of the study. Killed
at any time, the same command goes on from the last finished segment.
"""

import argparse
import logging
from pathlib import Path

from bedchain.case.load import load_case
from bedchain.errors import UserError, report_user_errors
from bedchain.lifetime import end_with_run
from bedchain.studies.tradeoff.bed_variants import bed_variants
from bedchain.studies.tradeoff.simulated_beds import simulate_bed


def run_variant(case_file: Path, folder: Path) -> None:
    """Simulate the variant that a folder is named after, or go on with it.

    Raises
    ------
    UserError
        The case has no such variant.
    """
    known = bed_variants(load_case(case_file))
    if folder.name not in known:
        raise UserError(f"there is no variant {folder.name}: take of {', '.join(known)}")
    simulate_bed(case_file, known[folder.name], folder)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("case", type=Path, help="the case file")
    parser.add_argument("folder", type=Path, help="results/<case>/tradeoff/<variant>")
    given = parser.parse_args()
    logging.basicConfig(format="run_variant: %(message)s")
    end_with_run()
    with report_user_errors():
        run_variant(given.case, given.folder)


if __name__ == "__main__":
    main()
