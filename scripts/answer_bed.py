# SPDX-License-Identifier: GPL-3.0-or-later
"""What a cheaper bed says of the case's bed, for the ladder: results/<case>/ladder/<variant>.json."""

from pathlib import Path

from bedchain.case.chosen import with_choice
from bedchain.case.load import load_case
from bedchain.dem.series import read_series
from bedchain.stage import run_stage
from bedchain.studies.cost.window_time import dem_row
from bedchain.studies.ladder.answers import write_answer
from bedchain.studies.ladder.simulated import bed_answer
from bedchain.trajectory.realisations import open_realisation
from bedchain.trajectory.store import read_manifest
from bedchain.trajectory.stored_dumps import write_trajectory


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
        A frame is missing or damaged; the run does not cover the windows.
    """
    folder = record.parent
    case = with_choice(load_case(folder / "case.yaml"), *choice or [folder])
    trajectory, metadata = folder / "trajectory.npy", folder / "trajectory.json"
    size = case["bed"]["width_m"], case["bed"]["height_m"]
    write_trajectory(folder / "dem.json", trajectory, metadata, *size, progress=False)
    try:
        run = open_realisation(folder.name, trajectory, metadata)
        series = read_series(folder / "bed_series.csv")
        window = case["comparison"]["start_s"], case["comparison"]["end_s"]
        spent_s = dem_row(read_manifest(folder / "dem.json"), *window)["cpu_s"]
        write_answer(bed_answer(model, run, series, spent_s / (window[1] - window[0]), case), answer)
    finally:  # as large as the dumps that it comes from
        trajectory.unlink(missing_ok=True)
        metadata.unlink(missing_ok=True)


if rule := globals().get("snakemake"):
    run_stage(answer_bed, rule)
