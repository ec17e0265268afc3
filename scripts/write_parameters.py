# SPDX-License-Identifier: GPL-3.0-or-later
"""Write a case's numbers for both solvers: parameters.lig (LIGGGHTS) and caseParameters (OpenFOAM).

usage: python scripts/write_parameters.py cases/short/case.yaml results/short [--preset fast]
"""

import argparse
from pathlib import Path

from bedchain.dem.parameter_files import write_parameters
from bedchain.errors import report_user_errors


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description="write a case's numbers for LIGGGHTS and OpenFOAM")
    parser.add_argument("case_file", type=Path, help="cases/<name>/case.yaml")
    parser.add_argument("folder", type=Path, help="results/<name>")
    parser.add_argument("--preset", help="of cases/presets.yaml, for its bed; the case's by default")
    arguments = parser.parse_args()
    with report_user_errors():
        write_parameters(arguments.case_file, arguments.folder, arguments.preset)


if __name__ == "__main__":
    main()
