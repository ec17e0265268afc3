# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulate a case's bed in restartable segments: settle without gas, then ramp the gas and run.

usage: python scripts/run_dem.py results/short --end 5 --segment 0.25 --ranks 2

The state is in results/<case>/dem/<stamp of the inputs>/. Killed at any time, the same command goes on from
the last finished segment; other inputs get a folder of their own, so earlier results stay. At the end it
writes dem.json (all frames) and bed_series.csv (pressure drop, bed height, conservation) into results/<case>.
"""

import argparse
import json
import os
import re
import shutil
from pathlib import Path

import pandas as pd

from bedchain.disk import require_disk
from bedchain.errors import UserError, report_user_errors
from bedchain.segments import (
    RESTART,
    SETTLED,
    Segment,
    check_frames,
    exclusive,
    finished_segments,
    frame_columns,
    input_stamp,
    manifest,
    read_parameters,
    whole_folder,
    write_record,
)
from bedchain.solver_process import Progress, on_ranks, run_logged

SOLVER = Path("results/bin/bedFoam")
DECKS = Path("liggghts_inputs")
GAS_CASE = Path("openfoam_case")
GAS_PARTS = ["0.orig", "constant", "system"]
ROW_EVERY = 10  # gas steps between two rows of bed_series.csv
BYTES_PER_PARTICLE = 500  # of LIGGGHTS's restart, with its contact history (480 measured)


def input_files(folder: Path) -> list[Path]:
    """Every file that the run depends on, in a fixed order."""
    given = [folder / "parameters.lig", folder / "caseParameters", SOLVER]
    decks = [DECKS / "in.settle", DECKS / "in.fluidize", *sorted((DECKS / "include").glob("*.in"))]
    gas = sorted(file for part in GAS_PARTS for file in (GAS_CASE / part).rglob("*") if file.is_file())
    missing = [str(file) for file in given if not file.exists()]
    if missing:
        raise UserError(
            f"{', '.join(missing)} missing: run snakemake, or scripts/write_parameters.py and build.sh"
        )
    return given + decks + gas


def settle(folder: Path, run: Path, ranks: int) -> None:
    """Drop the particles and let them come to rest; leaves ``settled/`` with their restart."""
    if (run / SETTLED).exists():
        return
    print("run_dem: settling the particles without gas", flush=True)
    with whole_folder(run / SETTLED) as part:
        deck = ["liggghts", "-in", f"{DECKS}/in.settle", "-log", "none", "-var", "decks", str(DECKS)]
        variables = ["-var", "parameters", str(folder / "parameters.lig"), "-var", "output", str(part)]
        run_logged(on_ranks(deck + variables, ranks), part / "liggghts.log")


def prepare_gas(gas: Path, folder: Path, previous: Path | None, settings: dict[str, object]) -> None:
    """Make the OpenFOAM case of a segment: a new mesh, or the mesh and the last fields of the one before."""
    source = GAS_CASE if previous is None else previous / "gas"
    for name in ["constant", "system"]:
        shutil.copytree(source / name, gas / name)
    shutil.copy(folder / "caseParameters", gas / "caseParameters")
    text = "".join(
        f'{name} "{value}";\n' if isinstance(value, str) else f"{name} {value};\n"
        for name, value in settings.items()
    )
    (gas / "segmentParameters").write_text(text, encoding="utf-8")
    if previous is None:
        shutil.copytree(GAS_CASE / "0.orig", gas / "0")
        run_logged(["blockMesh", "-case", str(gas)], gas / "mesh.log")
        if settings["ranks"] != 1:
            run_logged(["decomposePar", "-case", str(gas)], gas / "mesh.log")
        return
    for part in [source, *source.glob("processor*")]:
        last = last_time(part)
        if last is not None:
            shutil.copytree(last, gas / last.relative_to(source))
        if part != source:
            shutil.copytree(part / "constant", gas / part.name / "constant")


def last_time(folder: Path) -> Path | None:
    """The latest time folder of an OpenFOAM case or of a rank's part of it."""
    times = [item for item in folder.iterdir() if item.is_dir() and re.fullmatch(r"[0-9.]+", item.name)]
    return max(times, key=lambda item: float(item.name), default=None)


def run_segment(
    folder: Path, run: Path, index: int, steps: tuple[int, int], ranks: int, end_s: float
) -> Segment:
    """Advance bed and gas over one segment.

    Parameters
    ----------
    folder, run : Path
        ``results/<case>`` and its ``dem/<stamp>``.
    index : int
        Of the segment, from 1.
    steps : (int, int)
        First and last step of the particles.
    ranks : int
        MPI ranks.
    end_s : float
        Simulated time at the end of the whole run [s], for the time left.

    Returns
    -------
    Segment
        Its record, already in its folder.
    """
    parameters = read_parameters(folder / "parameters.lig")
    step_s = float(parameters["dem_step"])
    name = f"segment_{index:04d}"
    previous = run / f"segment_{index - 1:04d}" if index > 1 else None
    with whole_folder(run / name) as part:
        settings: dict[str, object] = {
            "ranks": ranks,
            "start_time": round(steps[0] * step_s, 9),
            "end_time": round(steps[1] * step_s, 9),
            "start_step": steps[0],
            "row_every": ROW_EVERY,
            "deck": f"{DECKS}/in.fluidize",
            "decks": str(DECKS),
            "parameters": str(folder / "parameters.lig"),
            "restart": str((previous or run / SETTLED) / RESTART),
            "output": str(part),
        }
        prepare_gas(part / "gas", folder, previous, settings)
        progress = Progress(end_s)
        command = [str(SOLVER), "-case", str(part / "gas")] + (["-parallel"] if ranks > 1 else [])
        try:
            run_logged(on_ranks(command, ranks), part / "bedFoam.log", progress)
        except UserError as error:
            raise UserError(f"{error}\nlast good state: {(previous or run / SETTLED) / RESTART}") from None
        check_frames(part, *steps, int(parameters["frame_steps"]), str(parameters["dump_suffix"]))
        spent = progress.totals
        segment = Segment(index, *steps, name, spent["wall"], spent["dem"], spent["exchange"], spent["gas"])
        write_record(part, segment)
    return segment


def run_dem(folder: Path, end_s: float, segment_s: float, ranks: int) -> None:
    """Simulate up to `end_s` in segments of `segment_s` [s], then write ``dem.json``, ``bed_series.csv``."""
    parameters = read_parameters(folder / "parameters.lig")
    step_s, frame_steps = float(parameters["dem_step"]), int(parameters["frame_steps"])
    end_step, segment_steps = round(end_s / step_s), round(segment_s / step_s)
    for name, steps in [("--end", end_step), ("--segment", segment_steps)]:
        if steps <= 0 or steps % frame_steps:
            raise UserError(
                f"{name} must be a whole number of frame intervals, {frame_steps * step_s:g} s each"
            )
    stamp = input_stamp(input_files(folder), ranks)
    run = folder / "dem" / stamp
    with exclusive(folder / "dem"):
        settle(folder, run, ranks)
        segments = finished_segments(run)
        while (start := segments[-1].end_step if segments else 0) < end_step:
            stop = min(start + segment_steps, end_step)
            frame_bytes = 8 * len(frame_columns(parameters)) * (stop - start) // frame_steps
            require_disk(folder, int(parameters["number"]) * (BYTES_PER_PARTICLE + frame_bytes))
            segments.append(run_segment(folder, run, len(segments) + 1, (start, stop), ranks, end_s))
        write_results(folder, stamp, segments, end_step, ranks)


def write_results(folder: Path, stamp: str, segments: list[Segment], end_step: int, ranks: int) -> None:
    """Write ``bed_series.csv`` and ``dem.json`` of the finished segments, moved into place when complete."""
    needed = [segment for segment in segments if segment.start_step < end_step]
    found = manifest(folder, stamp, needed, end_step, ranks)
    tables = [
        pd.read_csv(folder / "dem" / stamp / segment.folder / "gas" / "bed_series.csv") for segment in needed
    ]
    series = pd.concat(tables)
    part = folder / "bed_series.csv.part"
    series[series["time_s"] <= end_step * float(str(found["dem_step_s"])) * (1 + 1e-9)].to_csv(
        part, index=False
    )
    os.replace(part, folder / "bed_series.csv")
    part = folder / "dem.json.part"
    part.write_text(json.dumps(found, indent=1), encoding="utf-8")
    os.replace(part, folder / "dem.json")


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path, help="results/<case>, with parameters.lig and caseParameters")
    parser.add_argument("--end", type=float, required=True, help="simulated time at the end [s]")
    parser.add_argument("--segment", type=float, required=True, help="simulated time of a segment [s]")
    parser.add_argument("--ranks", type=int, default=1, help="MPI ranks (default 1)")
    arguments = parser.parse_args()
    with report_user_errors():
        run_dem(arguments.folder, arguments.end, arguments.segment, arguments.ranks)


if __name__ == "__main__":
    main()
