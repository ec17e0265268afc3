# SPDX-License-Identifier: GPL-3.0-or-later
"""Accuracy against cost, of chains and simulated beds: results/<case>/tradeoff.csv and presets.yaml.

usage: python scripts/study_tradeoff.py cases/short/case.yaml results/short --variants base drag_koch_hill

The folder holds the case's run (trajectory, bed_series.csv), its repeats, and variants of run_variant.py in
<folder>/tradeoff/. What was finished is kept there: the same command goes on after a stop.
"""

import argparse
import math
from pathlib import Path

import numpy as np
import pandas as pd

from bedchain.case.chosen import with_choice
from bedchain.case.load import load_case
from bedchain.case.parcels import parcel_case
from bedchain.case.schema import Case
from bedchain.dem.repeats import repeat_folder
from bedchain.errors import UserError
from bedchain.files import write_csv
from bedchain.provenance import machine
from bedchain.stage import LOG, known_files, stage
from bedchain.studies.marked_starts import Start, starts_in
from bedchain.studies.records import remove_other_results, stamp
from bedchain.studies.scan import Task
from bedchain.studies.tradeoff import measured_chains, presets, simulated_beds
from bedchain.studies.tradeoff.bed_variants import bed_variants
from bedchain.studies.tradeoff.chain_settings import CaseChain
from bedchain.studies.tradeoff.observables import Reference, all_columns
from bedchain.studies.tradeoff.reference import compared, own_grid, realisations, splits_of
from bedchain.trajectory.frames import lag_frames, window
from bedchain.trajectory.realisations import Realisation, open_realisation, open_repeats
from bedchain.uncertainty.bands import memory
from bedchain.uncertainty.noise_floor import ROUND_OFF

LABELS = ["half", "axis", "variant", "changed", "model", "estimator", "cell_width_m", "cell_height_m",
          "lag_s", "learning_start_s", "learning_end_s", "tracers"]  # fmt: skip
COSTS = ["learn_s", "run_s", "cost_s", "memory_mb"]
VALIDATION = ["validation_error_1", "validation_ci_low_1", "validation_ci_high_1"]


def study_tradeoff(case_file: Path, folder: Path, variants: list[str]) -> None:
    """Measure chains of many settings, and variants that were simulated, against one bed and its repeats.

    Parameters
    ----------
    case_file : Path
    folder : Path
        ``trajectory.npy``, ``trajectory.json``, ``bed_series.csv`` and ``repeats/`` of the case; gets
        ``tradeoff.csv``, ``presets.yaml``, and ``tradeoff/`` with what a stopped study goes on from.
    variants : list of str
        Names of `bed_variants.bed_variants` that run_variant.py has simulated.

    Raises
    ------
    UserError, DataError
        A window or a repeat lacks frames; no chain could be validated; there is no such variant, or it is not
        simulated.
    """
    case = with_choice(load_case(case_file), folder / "choice.csv")
    known = bed_variants(case)
    if unknown := sorted(set(variants) - set(known)):
        raise UserError(f"there is no variant {', '.join(unknown)}: take of {', '.join(known)}")
    bench, files = opened(case, folder)
    kept = remove_other_results(folder / "tradeoff" / "settings" / stamp(files, {"case": case}))
    table = pd.DataFrame(measured_chains.measure_all(bench, kept))
    floors = bench.reference.floors()
    floor = floors["mixing"] if floors["mixing"] > ROUND_OFF else np.nan
    chosen = presets.choose(table, floor)
    table["preset"] = [
        " ".join(name for name, row in chosen.items() if row == at) for at in table.index
    ]  # fmt: skip
    beds = simulated_beds.measure_all(
        [known[name] for name in variants], folder / "tradeoff", bench.reference
    )
    table = pd.concat([table, pd.DataFrame(beds)], ignore_index=True) if beds else table
    write_csv(
        table.reindex(columns=[*LABELS, "preset", *COSTS, *VALIDATION, *all_columns(), "problem"]),
        folder / "tradeoff.csv",
    )
    about = machine()
    measured_on = f"{case['title']}; {about['processor']}, one core"
    presets.write_presets(table, chosen, bench.base, measured_on, folder / "presets.yaml")
    for name, row in chosen.items():
        LOG.info("%s: %s, %.3g s", name, table.loc[row, "variant"], table.loc[row, "cost_s"])


def opened(case: Case, folder: Path) -> tuple[measured_chains.Bench, list[Path]]:
    """The bench of a case, and the files that it depends on."""
    numbers = range(1, case["comparison"]["repeats"] + 1)
    repeats = [repeat_folder(folder, number) for number in numbers]
    mixing = [repeat / "mixing.csv" for repeat in repeats]
    moving = [repeat / "trajectory.npy" for repeat in repeats if (repeat / "trajectory.npy").exists()]
    main = folder / "trajectory.npy"
    run = open_realisation("the run", main, main.with_suffix(".json"))
    runs = [run, *open_repeats(moving, run)]
    series = [path.parent / "bed_series.csv" for path in (main, *moving)]
    grid, which = own_grid(run, case), compared(run, case)
    learning = window(run.times_s, case["learning"]["start_s"], case["learning"]["end_s"])
    lag, splits = lag_frames(case["chain"]["lag_s"], run.interval_s), splits_of(case)
    spacing = math.ceil(memory(run.frames(grid, learning), splits[0]))
    starts = starts_in(which, spacing)[: 1 if mixing else None]
    reference = realisations(runs, series, mixing, case, starts)
    say(reference, runs, starts)
    length = starts[0].length
    models = tuple(case["chain"]["models"])
    own = CaseChain(grid, lag, case["chain"]["estimator"], learning, length, run.interval_s,
              parcel_case(case)["particles"]["diameter_m"], splits, models)  # fmt: skip
    task = Task(grid, splits, own.estimator, spacing, length)
    folds, seed = measured_chains.folds(run, learning, task), case["chain"]["seed"]
    return measured_chains.Bench(run, own, task, reference, folds, tuple(starts), seed), [
        main,
        *mixing,
        *series,
    ]


def say(reference: Reference, runs: list[Realisation], starts: list[Start]) -> None:
    """What the noise floors are from."""
    if reference.repeated:
        LOG.info("noise floor of the curves: %d realisations", len(reference.curves))
    else:
        LOG.info("no repeats, so no noise floor of the curves: intervals are over %d starts", len(starts))
    LOG.info("noise floor of the density: %s", f"{len(runs)} realisations" if len(runs) > 1 else
             "the two halves of the comparison window, there are no positions of repeats")  # fmt: skip


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("case", type=Path, help="the case file")
    parser.add_argument("folder", type=Path, help="results/<case>")
    parser.add_argument(
        "--variants", nargs="*", default=[], metavar="NAME", help="beds that run_variant.py has simulated"
    )
    parser.add_argument("--log", type=Path, default=Path("study_tradeoff.log"), help="log file")
    given = parser.parse_args()
    folder = given.folder
    inputs = [*folder.glob("**/bed_series.csv"), *folder.glob("**/mixing.csv"), *folder.glob("trajectory.*")]
    with stage(given.log), known_files(inputs, [folder / "tradeoff.csv"]):
        study_tradeoff(given.case, given.folder, given.variants)


if __name__ == "__main__":
    main()
