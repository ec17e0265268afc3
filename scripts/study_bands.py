# SPDX-License-Identifier: GPL-3.0-or-later
"""How often the 95 % bands hold the truth; write results/bands/coverage.csv.

usage: python scripts/study_bands.py
       python scripts/study_bands.py --beds paper short:2.5

A bed is a case with results, and the time from which it is steady [s]: by default the start of its learning
window.
"""

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from bedchain.case.load import load_case
from bedchain.errors import UserError, report_user_errors
from bedchain.files import write_csv
from bedchain.measures.mixing import Splits
from bedchain.studies.coverage import TIMES, Covered, ar1_rows, bed_rows, gust_rows, walk_rows
from bedchain.trajectory.frames import Window
from bedchain.trajectory.realisations import open_bed
from bedchain.trajectory.store import BedFiles

OUTPUT = Path("results/bands/coverage.csv")
SEED = 17
SAMPLES, WINDOWS = 2000, 40
# windows of the walk are learned from one by one, those of beds are few
WALK_TIMES, BED_TIMES = TIMES[:3], TIMES[:3]
MODELS = ("static",)


def study_bands(beds: Sequence[str], output: Path, samples: int = SAMPLES, windows: int = WINDOWS) -> None:
    """Measure the coverage of each process and bed.

    Parameters
    ----------
    beds : sequence of str
        ``<case>`` or ``<case>:<start in s>``, of cases with results.
    output : Path
        Table to make: the fields of `coverage.Covered`.
    samples, windows : int
        Series of a process, and windows of the walk.
    """
    rng, rows = np.random.default_rng(SEED), []
    parts: list[Iterator[Covered]] = [ar1_rows(TIMES, samples, rng), gust_rows(TIMES, samples, rng)]
    parts += [walk_rows(WALK_TIMES, windows, SEED), *map(rows_of_bed, beds)]
    for part in parts:
        for row in part:
            rows.append(row)
            share = f"{100 * row.covered_1:.1f} % of {row.samples_1}"
            print(f"{row.process}, {row.correlation_times_1:.3g} correlation times: {share}", flush=True)
    write_csv(pd.DataFrame(rows, columns=list(Covered._fields)), output)


def rows_of_bed(bed: str) -> Iterator[Covered]:
    """Coverage on a bed, ``<case>`` or ``<case>:<start in s>``.

    Raises
    ------
    UserError
        The word is no case and time, or the case has no results.
    """
    name, colon, start = bed.partition(":")
    case, results = load_case(Path("cases") / name / "case.yaml"), Path("results") / name
    try:
        start_s = float(start) if colon else case["learning"]["start_s"]
    except ValueError:
        raise UserError(f"--beds {bed}: give a case and the time from which it is steady, paper:10") from None
    files = BedFiles(*(results / file for file in ("trajectory.npy", "trajectory.json", "cells.npz")))
    if not (results / "cells.npz").exists():
        raise UserError(f"there is no {results / 'cells.npz'}: run ./run --config case={name} first")
    run = open_bed(files)
    split_x_m = case["mixing"].get("split_x_m", case["bed"]["width_m"] / 2)
    splits = Splits(split_x_m, case["mixing"]["split_z_m"])
    frames = run.window(Window(start_s, case["comparison"]["end_s"]))
    return bed_rows(name, frames, run.grid, splits, BED_TIMES, MODELS)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--beds", nargs="*", default=[], help="cases with results, such as paper or paper:10")
    parser.add_argument("--output", type=Path, default=OUTPUT, help="csv to write")
    given = parser.parse_args()
    with report_user_errors():
        study_bands(given.beds, given.output)


if __name__ == "__main__":
    main()
