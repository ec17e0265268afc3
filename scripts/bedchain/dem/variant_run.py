# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulation of one variant of a case in a folder of its own, by a process of its own."""

import os
import sys
from pathlib import Path

from bedchain.case.load import load_case
from bedchain.case.schema import Case
from bedchain.case.variants import Variant, write_variant
from bedchain.dem.parameter_files import write_parameters
from bedchain.dem.processes import run_logged
from bedchain.dem.run import run_dem
from bedchain.errors import report_user_errors

LIBRARY = Path(__file__).resolve().parents[2]


def simulate(case_file: Path, variant: Variant, folder: Path, ranks: int = 1) -> Case:
    """Simulate a variant to its end, or go on from the last finished segment of an earlier try.

    Parameters
    ----------
    case_file : Path
        The case that it varies.
    variant : Variant
    folder : Path
        Gets what ``results/<case>`` of a simulated case holds: ``dem.json``, ``bed_series.csv``, ``dem/``.
    ranks : int
        MPI ranks.

    Returns
    -------
    dict
        The variant's checked case.

    Raises
    ------
    UserError
        It cannot be run, or its solvers stopped: why, in their own words.
    """
    case = write_variant(case_file, variant, folder)
    log = folder / "simulate.log"
    log.unlink(missing_ok=True)
    command = [sys.executable, "-m", "bedchain.dem.variant_run", str(folder), str(ranks)]
    run_logged(command, log, variables={"PYTHONPATH": library_path()})
    return case


def library_path() -> str:
    """``PYTHONPATH`` with this library first."""
    given = os.environ.get("PYTHONPATH")
    return os.pathsep.join([str(LIBRARY), *([given] if given else [])])


def run_variant(folder: Path, ranks: int) -> None:
    """Simulate the case in a folder; its output is the caller's log."""
    time = load_case(folder / "case.yaml")["time"]
    write_parameters(folder / "case.yaml", folder)
    run_dem(folder, time["end_s"], time["segment_s"], ranks)


if __name__ == "__main__":
    with report_user_errors():
        run_variant(Path(sys.argv[1]), int(sys.argv[2]))
