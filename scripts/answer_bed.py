# SPDX-License-Identifier: GPL-3.0-or-later
"""What a cheaper bed says of the case's bed, for the ladder: results/<case>/ladder/<variant>.json."""

import json
from pathlib import Path

from bedchain.case.chosen import with_choice
from bedchain.case.load import load_case
from bedchain.dem.series import read_series
from bedchain.errors import UserError
from bedchain.stage import run_stage
from bedchain.studies.cost.window_time import dem_row
from bedchain.studies.ladder.answers import write_answer
from bedchain.studies.ladder.simulated import bed_answer
from bedchain.trajectory.store import read_manifest
from bedchain.trajectory.stored_dumps import parsed_run


def answer_bed(record: Path, choice: list[Path], answer: Path, model: str) -> None:
    """Measure a variant of the bed as the ladder measures the bed itself.

    Parameters
    ----------
    record : Path
        ``variant.json``, in the folder with the variant's case and run.
    choice : list of Path
        ``choice.csv`` where the case leaves lag or cells to it.
    answer : Path
        JSON to make, as `answers.write_answer` does.
    model : str
        Its name in the ladder.

    Raises
    ------
    DataError, UserError
        The variant ended with an error; a frame is missing or damaged.
    """
    folder = record.parent
    case = with_choice(load_case(folder / "case.yaml"), *choice or [folder])
    if problem := json.loads(record.read_text(encoding="utf-8"))["problem"]:
        raise UserError(f"{folder} was not simulated to its end: {problem}")
    series = read_series(folder / "bed_series.csv")
    start_s, end_s = case["comparison"]["start_s"], case["comparison"]["end_s"]
    cost_s = dem_row(read_manifest(folder / "dem.json"), start_s, end_s)["cpu_s"] / (end_s - start_s)
    with parsed_run(folder, case["bed"]["width_m"], case["bed"]["height_m"]) as run:
        write_answer(bed_answer(model, run, series, cost_s, case), answer)


if rule := globals().get("snakemake"):
    run_stage(answer_bed, rule)
