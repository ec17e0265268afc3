# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulation of one variant of a case in a folder of its own."""

import os
import sys
from pathlib import Path

from bedchain.case.schema import Case
from bedchain.case.variants import Variant, write_variant
from bedchain.dem.processes import run_logged


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
    times = {"--end": case["time"]["end_s"], "--segment": case["time"]["segment_s"], "--ranks": ranks}
    options = [str(word) for option in times.items() for word in option]
    log = folder / "simulate.log"
    log.unlink(missing_ok=True)
    for script, arguments in (
        ("write_parameters", [os.fspath(folder / "case.yaml"), os.fspath(folder)]),
        ("run_dem", [os.fspath(folder), *options]),
    ):
        run_logged([sys.executable, f"scripts/{script}.py", *arguments], log)
    return case
