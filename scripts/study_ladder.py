# SPDX-License-Identifier: GPL-3.0-or-later
"""The ladder of models on one bed, cost against error: results/<case>/ladder.csv."""

from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from bedchain.case.chosen import read_choice
from bedchain.case.schema import Case
from bedchain.dem.memory import memory_needs
from bedchain.dem.series import read_series
from bedchain.files import write_csv
from bedchain.physics.two_phase import RegimeError
from bedchain.stage import LOG, run_stage
from bedchain.studies.cost.window_time import dem_row
from bedchain.studies.ladder import models
from bedchain.studies.ladder.answers import Answer, ladder_rows, read_answer
from bedchain.studies.ladder.simulated import dem_rows, read_curves, truth_of
from bedchain.studies.two_fluid_summary import read_summary
from bedchain.trajectory.frames import Window
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import Realisation, open_bed
from bedchain.trajectory.store import BedFiles, read_manifest

LEARNED = ("velocity_class", "jump", "recurrence")  # beside the static and dynamic chains


@dataclass(frozen=True)
class LadderInputs:
    """Tables of the run.

    Attributes
    ----------
    dem, bed_series, mixing, choice : Path
        ``dem.json``, ``bed_series.csv``, ``mixing.csv`` with the repeats, ``choice.csv``.
    """

    dem: Path
    bed_series: Path
    mixing: Path
    choice: Path


def study_ladder(
    bed: BedFiles, inputs: LadderInputs, two_fluid: list[Path], others: list[Path], ladder: Path, case: Case
) -> None:
    """Ask every model what it can say of the bed, beside each other on one core.

    Parameters
    ----------
    bed : BedFiles
    inputs : LadderInputs
    two_fluid : list of Path
        ``record.json`` of each two-fluid run, in the folder of its summary; may be empty.
    others : list of Path
        ``cases/<case>/ladder/*.json``: models that ran elsewhere, as `answers.write_answer` writes them.
    ladder : Path
        Table to make: model, quantity, value, truth, unit, error_1, noise_floor_1, error_floors,
        cost_s_per_s, learning_s, memory_mb, note.
    case : dict
    """
    run, series = open_bed(bed), read_series(inputs.bed_series)
    windows = [Window(case[name]["start_s"], case[name]["end_s"]) for name in ("learning", "comparison")]
    spans = windows[0].frames(run.times_s), windows[1].frames(run.times_s)
    window_s = windows[1].end_s - windows[1].start_s
    truth = truth_of(run, spans, series, read_curves(inputs.mixing), run.grid, case)
    spent = dem_row(read_manifest(inputs.dem), *windows[1])["cpu_s"]
    answers: list[Answer] = []
    for setting in settings_of(case, run, inputs.choice):
        answers.append(models.of_chain(setting, run, spans, case, case["chain"]["estimator"], run.grid))
        LOG.info("%s: %.3g s of a core a simulated second", setting.name, answers[-1].cost_s)
    for record in two_fluid:
        answers += models.of_two_fluid(read_summary(record.parent), run.grid, case)
    try:
        answers.append(models.of_two_phase(case, run.grid, window_s))
        answers.append(models.of_wakes(case, run.grid, window_s, run.interval_s))
    except RegimeError as error:
        LOG.info("two-phase: %s", error)
    answers.append(models.plug_flow(window_s, run.interval_s))
    answers += [read_answer(file) for file in others]
    memory_mb = memory_needs(case)["the simulation"] / 1e6
    rows = [dem_rows(truth, spent / window_s, memory_mb), ladder_rows(answers, truth)]
    write_csv(pd.concat(rows, ignore_index=True), ladder)


def settings_of(case: Case, run: Realisation, choice: Path) -> list[models.Setting]:
    """Chains of the ladder: both of the paper on the case's cells, the others by rule."""
    own, lag_s, options = run.grid, case["chain"]["lag_s"], case["chain"]
    chosen = read_choice(choice)
    grid = Grid(run.width_m, run.height_m, chosen.columns, chosen.rows)

    def by_rule(name: str) -> models.Setting:
        return models.Setting(name.replace("_", " "), name, grid, chosen.lag_s, dict(options.get(name, {})))

    return [
        models.Setting("static, the paper's", "static", own, lag_s, {}),
        models.Setting("static, chosen", "static", grid, chosen.lag_s, {}),
        models.Setting("dynamic", "dynamic", own, lag_s, dict(options.get("dynamic", {}))),
        *(by_rule(name) for name in LEARNED),
    ]


if rule := globals().get("snakemake"):
    run_stage(study_ladder, rule)
