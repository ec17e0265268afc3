# SPDX-License-Identifier: GPL-3.0-or-later
"""The DEM run of a case: the bed settled without gas, then segments of bed and gas, or of a turning drum.

A repeat is another realisation: it starts from a state of the finished run, each velocity changed a little.
"""

import json
from collections.abc import Callable
from itertools import count
from pathlib import Path

import pandas as pd

from bedchain.dem import drum
from bedchain.dem.disk import require_disk
from bedchain.dem.gas_case import GAS_CASE, GAS_PARTS
from bedchain.dem.repeats import (
    DECK,
    KICK_M_S,
    PERTURBED,
    kick_seed,
    perturb,
    repeat_folder,
    segment_that_ends,
)
from bedchain.dem.restarts import check_restart, complete
from bedchain.dem.segment_run import SOLVER, origin_record, run_segment, settle
from bedchain.dem.segments import (
    DECKS,
    RESTART,
    SERIES,
    SETTLED,
    Segment,
    SegmentedRun,
    finished,
    frame_columns,
    input_stamp,
    manifest,
    read_parameters,
    write_record,
)
from bedchain.errors import DataError, UserError
from bedchain.files import atomic_file, atomic_folder, locked_folder, write_text
from bedchain.fingerprints import note_fingerprints
from bedchain.trajectory.store import read_manifest, retract

BYTES_PER_PARTICLE = 500  # of LIGGGHTS's restart, with its contact history (480 measured)


def input_files(folder: Path) -> list[Path]:
    """Every file that the run depends on, in a fixed order.

    Raises
    ------
    UserError
        Parameters or solver are missing.
    """
    if drum.is_drum(folder):
        return drum.input_files(folder, DECKS)
    given = [folder / "parameters.lig", folder / "caseParameters", SOLVER]
    decks = [DECKS / "in.settle", DECKS / "in.fluidize", *sorted((DECKS / "include").glob("*.in"))]
    gas = sorted(file for part in GAS_PARTS for file in (GAS_CASE / part).rglob("*") if file.is_file())
    missing = [str(file) for file in given if not file.exists()]
    if missing:
        raise UserError(
            f"{', '.join(missing)} missing: run snakemake, or scripts/write_parameters.py and build.sh"
        )
    return given + decks + gas


def whole_steps(folder: Path, times: dict[str, float]) -> list[int]:
    """Times as steps of the particles.

    Parameters
    ----------
    folder : Path
        ``results/<case>``.
    times : dict of str to float
        By the option that gives each [s].

    Returns
    -------
    list of int

    Raises
    ------
    UserError
        A time is no whole number of frame intervals.
    """
    parameters = read_parameters(folder / "parameters.lig")
    step_s, frame_steps = float(parameters["dem_step"]), int(parameters["frame_steps"])
    counts = {name: round(time / step_s) for name, time in times.items()}
    for name, steps in counts.items():
        if steps <= 0 or steps % frame_steps:
            raise UserError(
                f"{name} must be a whole number of frame intervals, {frame_steps * step_s:g} s each"
            )
    return list(counts.values())


def run_dem(folder: Path, end_s: float, segment_s: float, ranks: int) -> None:
    """Simulate a case, or go on from the last finished segment, then write ``dem.json``, ``bed_series.csv``.

    Parameters
    ----------
    folder : Path
        ``results/<case>``, with ``parameters.lig`` and ``caseParameters``.
    end_s, segment_s : float
        End, and length of a segment [s].
    ranks : int
        MPI ranks; finished segments may have had others.

    Raises
    ------
    UserError
        A time or a file is wrong, another process is at work, or a solver stops.
    """
    end, length = whole_steps(folder, {"--end": end_s, "--segment": segment_s})
    run = SegmentedRun(folder, folder, input_stamp(input_files(folder)), ranks, 0, end, SETTLED)
    with locked_folder(folder / "dem"):
        advance(run, length, lambda: settle(run))


def repeat_dem(
    folder: Path, start_s: float, end_s: float, segment_s: float, ranks: int, number: int,
    kick_m_s: float = KICK_M_S,
) -> None:  # fmt: skip
    """Simulate the bed again from a perturbed state of the finished run.

    Parameters
    ----------
    folder : Path
        ``results/<case>``; ``dem.json`` says which run it is. ``repeats/<number>`` in it gets the results.
    start_s : float
        End of one of the run's segments [s].
    end_s, segment_s : float
        End, and length of a segment [s].
    ranks : int
        MPI ranks; the run may have had others.
    number : int
        Of the repeat, from 1: each has its own perturbation.
    kick_m_s : float
        Size of the perturbation [m/s].

    Raises
    ------
    UserError
        There is no run, or none of its segments ends at `start_s`.
    """
    main = read_manifest(folder / "dem.json")
    start, end, length = whole_steps(folder, {"--start": start_s, "--end": end_s, "--segment": segment_s})
    if end <= start:
        raise UserError(f"--end, {end_s:g} s, must be after --start, {start_s:g} s")
    segment = folder / segment_that_ends(main, start_s)
    try:
        finished(segment)
    except DataError as error:
        raise UserError(f"{error}\n{retract(folder / 'dem.json', segment)}") from error
    results = repeat_folder(folder, number)
    stamp = input_stamp([*input_files(folder), DECKS / DECK, segment / RESTART], f"{number} {kick_m_s}")
    run = SegmentedRun(folder, results, stamp, ranks, start, end, PERTURBED)
    seed = kick_seed(int(read_parameters(folder / "parameters.lig")["seed"]), number)

    def begin() -> None:
        with atomic_folder(run.state / run.origin) as part:
            perturb(run, segment, part, DECKS, seed, kick_m_s)
            with complete(part):
                check_restart(part / RESTART, main["number"])
            write_record(part, origin_record(run))

    with locked_folder(results / "dem"):
        advance(run, length, begin)


def advance(run: SegmentedRun, segment_steps: int, begin: Callable[[], None]) -> None:
    """Add segments until the run has reached its end, then write what it left behind.

    Each finished segment is compared with its record first. One that is damaged is named and made again
    from the one before it; those after it stay if they follow from what is made.

    Parameters
    ----------
    run : SegmentedRun
    segment_steps : int
        Length of a segment.
    begin : callable
        Makes the folder that the first segment goes on from.
    """
    if run.results == run.case:
        print(f"run_dem: to see the bed while it runs, ./run look {run.case.name}", flush=True)
    say_lost(run)
    if _usable(run.state / run.origin, run.start_step) is None:
        begin()
    before = finished(run.state / run.origin)
    assert before is not None
    segments: list[Segment] = []
    while before.end_step < run.end_step:
        index, start = len(segments) + 1, before.end_step
        segment = _usable(run.state / f"segment_{index:04d}", start, before.state)
        if segment is None:
            stop = min(start + segment_steps, run.end_step)
            _require_disk(run, stop - start)
            segment = run_segment(run, index, (start, stop), before.state)
        segments.append(segment)
        before = segment
    write_results(run, segments)


def _usable(folder: Path, start_step: int, follows: str = "") -> Segment | None:
    """What `segments.finished` finds in a folder; a damaged one is named and put aside."""
    try:
        return finished(folder, start_step, follows)
    except DataError as error:
        aside = (folder.with_name(f"{folder.name}.damaged_{number}") for number in count(1))
        target = next(name for name in aside if not name.exists())
        folder.replace(target)
        print(f"run_dem: {folder.name} is made again, it is {target.name} now: {error}", flush=True)
        return None


def say_lost(run: SegmentedRun) -> None:
    """Say what of the last try is lost: the folder that it was ended in."""
    for part in run.state.glob("*.part"):
        frames = len(list(part.glob("frame_*")))
        print(
            f"run_dem: the last try was ended within {part.stem}, of which {frames} frames are lost; "
            "it is made again",
            flush=True,
        )


def _require_disk(run: SegmentedRun, steps: int) -> None:
    parameters = read_parameters(run.case / "parameters.lig")
    frame_bytes = 8 * len(frame_columns(parameters)) * steps // int(parameters["frame_steps"])
    require_disk(run.results, int(parameters["number"]) * (BYTES_PER_PARTICLE + frame_bytes))


def write_results(run: SegmentedRun, segments: list[Segment]) -> None:
    """Write ``bed_series.csv`` and, last, ``dem.json`` of the finished segments, each whole or not at all."""
    content = manifest(run, segments)
    inside = "" if drum.is_drum(run.case) else "gas"
    files = [run.state / segment.folder / inside / SERIES for segment in segments]
    series = pd.concat(map(pd.read_csv, files))
    end_s = run.end_step * float(str(content["dem_step_s"])) * (1 + 1e-9)
    with atomic_file(run.results / SERIES) as temporary:
        series[series["time_s"] <= end_s].to_csv(temporary, index=False)
    write_text(run.results / "dem.json", json.dumps(content, indent=1))
    note_fingerprints([run.results / SERIES, run.results / "dem.json"])
