# SPDX-License-Identifier: GPL-3.0-or-later
"""Cost and error of the case's own chains and of the presets: results/<case>/preset_errors.csv."""

import math
from pathlib import Path

import numpy as np
import pandas as pd

from bedchain.case.chosen import read_choice, with_choice
from bedchain.case.presets import read_presets
from bedchain.case.schema import Case
from bedchain.comparison.curves import curves_of
from bedchain.errors import UserError
from bedchain.files import write_csv
from bedchain.stage import LOG, run_stage
from bedchain.studies.preset_scores import Realised, chains_of, preset_rows
from bedchain.studies.scan import Task
from bedchain.studies.scores.held_out import hold_out
from bedchain.studies.tradeoff.reference import own_grid, splits_of
from bedchain.trajectory.frames import Window
from bedchain.trajectory.realisations import open_bed, open_repeats
from bedchain.trajectory.store import BedFiles
from bedchain.uncertainty.bands import memory, shortness

COLUMNS = ["chain", "model", "columns", "rows", "cell_m", "lag_s", "learn_s", "between_s", "run_s", "cost_s",
           "starts", "error_1", "spread_of_starts_1", "over_spread_1", "ci_low_1", "ci_high_1",
           "single_error_1", "noise_floor_1", "over_floor_1", "problem"]  # fmt: skip


def score_presets(
    bed: BedFiles, repeats: list[Path], curves: list[Path], choice: Path, presets: Path, table: Path,
    case: Case,
) -> None:  # fmt: skip
    """Learn and run the case's own chains and those of the presets, beside another DEM run.

    Parameters
    ----------
    bed : BedFiles
    repeats : list of Path
        ``trajectory.npy`` of each repeat whose positions are there; may be empty.
    curves : list of Path
        ``mixing.csv`` of each repeat; may be empty.
    choice : Path
        ``choice.csv``.
    presets : Path
        ``cases/presets.yaml``.
    table : Path
        Gets a row for each chain: `preset_scores.preset_rows`.
    case : Case

    Raises
    ------
    UserError, DataError
        The comparison window begins inside the learning window, or lacks frames; cells are no boxes of a
        flat bed.
    """
    case = with_choice(case, choice)
    run = open_bed(bed)
    runs = [run, *open_repeats(repeats, run)]
    learning_s = case["learning"]["start_s"], case["learning"]["end_s"]
    learning = Window(*learning_s).frames(run.times_s)
    span = case["comparison"]["start_s"], case["comparison"]["end_s"]
    if Window(*span).frames(run.times_s).start + 1 < learning.stop:
        raise UserError("comparison.start_s is inside the learning window: take at least learning.end_s")
    grid, splits = own_grid(run, case), splits_of(case)
    apart = memory(run.frames(grid, learning), splits.split_x_m)
    held = hold_out(runs, grid, span, math.ceil(apart), splits, 0.0, [])
    length = held.starts[0].length
    tables = [pd.read_csv(file) for file in curves]
    others = [curves_of(one, one["source"].iloc[0], length + 1) for one in tables]
    before = hold_out([run], grid, learning_s, math.ceil(apart), splits, 0.0, [])
    realised = Realised(held, np.array(others), length / apart, before.curves)
    if words := shortness(realised.correlation_times):
        LOG.warning("comparison window: %s", words)
    task = Task(grid, splits, case["chain"]["estimator"], math.ceil(apart), length)
    chains = chains_of(case, list(read_presets(presets).values()), read_choice(choice), run.interval_s)
    rows = pd.DataFrame(preset_rows(chains, learning, realised, task)).reindex(columns=COLUMNS)
    write_csv(rows, table)
    for row in rows.to_dict("records"):
        LOG.info("%(chain)s: %(over_spread_1).2f spreads of starts, %(over_floor_1).2f noise floors", row)


if rule := globals().get("snakemake"):
    run_stage(score_presets, rule)
