# SPDX-License-Identifier: GPL-3.0-or-later
"""Run a bed as two fluids to its end, or go on with it, and write its summary: results/<case>/two_fluid/.

usage: python scripts/run_two_fluid.py cases/short/case.yaml results/short/two_fluid/10mm --cell 0.01

The run is in the folder <summary>/run, in segments of time.segment_s: a run that was ended goes on after its
last one. Another cell than the case's gets a gas step of the same Courant number.
"""

import argparse
from pathlib import Path

from bedchain.case.load import load_case
from bedchain.case.parameters import openfoam_text, solver_parameters
from bedchain.case.schema import Case, load_schema
from bedchain.case.two_fluid import two_fluid_case
from bedchain.dem.parameter_files import write_if_changed
from bedchain.dem.two_fluid import read_run, run_two_fluid
from bedchain.errors import report_user_errors
from bedchain.files import locked_folder
from bedchain.lifetime import end_with_run
from bedchain.studies.two_fluid_summary import summarise, write_summary


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("case", type=Path, help="cases/<case>/case.yaml")
    parser.add_argument("folder", type=Path, help="gets the summary and the run")
    parser.add_argument("--cell", type=float, metavar="M", help="edge of a cell [m]; the case's by default")
    given = parser.parse_args()
    end_with_run()
    with report_user_errors():
        run_and_summarise(two_fluid_case(load_case(given.case), given.cell), given.folder)


def run_and_summarise(case: Case, folder: Path) -> None:
    """Run a case of `two_fluid_case`, or go on with it, and write its summary."""
    run = folder / "run"
    run.mkdir(parents=True, exist_ok=True)
    with locked_folder(run):
        write_if_changed(run / "caseParameters", openfoam_text(solver_parameters(case, load_schema())))
        run_two_fluid(run, case)
        write_summary(summarise(read_run(run), case), folder)


if __name__ == "__main__":
    main()
