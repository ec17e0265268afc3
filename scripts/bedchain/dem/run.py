# SPDX-License-Identifier: GPL-3.0-or-later
"""The DEM run of a case: the bed settled without gas, then segments of bed and gas, or of a turning drum.

A repeat is another realisation: it starts from a state of the finished run, each velocity changed a little.
"""

import json
from pathlib import Path

import pandas as pd

from bedchain.dem import drum
from bedchain.dem.disk import require_disk
from bedchain.dem.gas_case import GAS_CASE, GAS_PARTS, prepare_gas
from bedchain.dem.processes import Progress, on_ranks, run_deck, run_logged
from bedchain.dem.repeats import (
    DECK,
    KICK_M_S,
    PERTURBED,
    kick_seed,
    perturb,
    repeat_folder,
    segment_that_ends,
)
from bedchain.dem.segments import (
    RESTART,
    SETTLED,
    Segment,
    SegmentedRun,
    finished_segments,
    frame_columns,
    input_stamp,
    keep_own_frames,
    manifest,
    read_parameters,
    write_record,
)
from bedchain.errors import UserError
from bedchain.files import atomic_file, atomic_folder, locked_folder, write_text
from bedchain.trajectory.store import read_manifest

SOLVER = Path("results/bin/bedFoam")
DECKS = Path("liggghts_inputs")
ROW_EVERY = 10  # gas steps between two rows of bed_series.csv
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


def settle(run: SegmentedRun) -> None:
    """Drop the particles and let them come to rest; leaves ``settled/`` with their restart.

    Parameters
    ----------
    run : SegmentedRun
        A state that is settled stays as it is.

    Raises
    ------
    UserError
        LIGGGHTS is not there or stops.
    """
    if (run.state / run.origin).exists():
        return
    print("run_dem: settling the particles without gas", flush=True)
    name = drum.FILL if drum.is_drum(run.case) else "in.settle"
    with atomic_folder(run.state / run.origin) as part:
        variables = {"decks": DECKS, "parameters": run.case / "parameters.lig", "output": part}
        run_deck(DECKS / name, variables, part / "liggghts.log", run.ranks)


def run_segment(run: SegmentedRun, index: int, steps: tuple[int, int]) -> Segment:
    """Advance bed and gas over one segment.

    Parameters
    ----------
    run : SegmentedRun
    index : int
        Of the segment, from 1.
    steps : (int, int)
        First and last step of the particles.

    Returns
    -------
    Segment
        Its record, already in its folder.

    Raises
    ------
    UserError
        The solver is not there or stops: its own words, and the last good state.
    """
    parameters = read_parameters(run.case / "parameters.lig")
    step_s = float(parameters["dem_step"])
    name = f"segment_{index:04d}"
    previous = run.state / (f"segment_{index - 1:04d}" if index > 1 else run.origin)
    if drum.is_drum(run.case):
        return drum.run_segment(run, index, steps, previous, DECKS)
    with atomic_folder(run.state / name) as part:
        settings: dict[str, object] = {
            "ranks": run.ranks,
            "start_time": round(steps[0] * step_s, 9),
            "end_time": round(steps[1] * step_s, 9),
            "start_step": steps[0],
            "row_every": ROW_EVERY,
            "deck": f"{DECKS}/in.fluidize",
            "decks": str(DECKS),
            "parameters": str(run.case / "parameters.lig"),
            "restart": str(previous / RESTART),
            "output": str(part),
        }
        prepare_gas(part / "gas", run.case / "caseParameters", previous, settings)
        progress = Progress(run.end_step * step_s)
        command = [str(SOLVER), "-case", str(part / "gas")] + (["-parallel"] if run.ranks > 1 else [])
        try:
            run_logged(on_ranks(command, run.ranks), part / "bedFoam.log", progress)
        except UserError as error:
            raise UserError(f"{error}\nlast good state: {previous / RESTART}") from None
        keep_own_frames(part, run, steps, int(parameters["frame_steps"]), str(parameters["dump_suffix"]))
        spent = progress.totals
        segment = Segment(index, *steps, name, spent["wall"], spent["dem"], spent["exchange"], spent["gas"])
        write_record(part, segment)
    return segment


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
        MPI ranks.

    Raises
    ------
    UserError
        A time or a file is wrong, another process is at work, or a solver stops.
    """
    end, length = whole_steps(folder, {"--end": end_s, "--segment": segment_s})
    run = SegmentedRun(folder, folder, input_stamp(input_files(folder), ranks), ranks, 0, end, SETTLED)
    with locked_folder(folder / "dem"):
        settle(run)
        advance(run, length)


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
    results = repeat_folder(folder, number)
    stamp = input_stamp(
        [*input_files(folder), DECKS / DECK, segment / RESTART], ranks, f"{number} {kick_m_s}"
    )
    run = SegmentedRun(folder, results, stamp, ranks, start, end, PERTURBED)
    with locked_folder(results / "dem"):
        seed = kick_seed(int(read_parameters(folder / "parameters.lig")["seed"]), number)
        perturb(run, segment, DECKS, seed, kick_m_s)
        advance(run, length)


def advance(run: SegmentedRun, segment_steps: int) -> None:
    """Add segments until the run has reached its end, then write what it left behind."""
    parameters = read_parameters(run.case / "parameters.lig")
    segments = finished_segments(run.state)
    while (start := segments[-1].end_step if segments else run.start_step) < run.end_step:
        stop = min(start + segment_steps, run.end_step)
        frame_bytes = 8 * len(frame_columns(parameters)) * (stop - start) // int(parameters["frame_steps"])
        require_disk(run.results, int(parameters["number"]) * (BYTES_PER_PARTICLE + frame_bytes))
        segments.append(run_segment(run, len(segments) + 1, (start, stop)))
    write_results(run, [segment for segment in segments if segment.start_step < run.end_step])


def write_results(run: SegmentedRun, segments: list[Segment]) -> None:
    """Write ``bed_series.csv`` and ``dem.json`` of the finished segments, moved into place when complete."""
    content = manifest(run, segments)
    inside = "" if drum.is_drum(run.case) else "gas"
    files = [run.state / segment.folder / inside / drum.SERIES for segment in segments]
    series = pd.concat(map(pd.read_csv, files))
    end_s = run.end_step * float(str(content["dem_step_s"])) * (1 + 1e-9)
    with atomic_file(run.results / "bed_series.csv") as temporary:
        series[series["time_s"] <= end_s].to_csv(temporary, index=False)
    write_text(run.results / "dem.json", json.dumps(content, indent=1))
