# SPDX-License-Identifier: GPL-3.0-or-later
"""The making of a settled bed and of a segment by the solvers, and the check of what they left."""

from collections.abc import Mapping
from pathlib import Path

from bedchain.dem import drum
from bedchain.dem.gas_case import prepare_gas
from bedchain.dem.processes import Progress, longest_silence, on_ranks, run_deck, run_logged
from bedchain.dem.restarts import check_gas, check_restart, check_series, complete
from bedchain.dem.segments import (
    DECKS,
    RESTART,
    SERIES,
    Segment,
    SegmentedRun,
    keep_own_frames,
    read_parameters,
    write_record,
)
from bedchain.errors import DataError, UserError
from bedchain.files import atomic_folder
from bedchain.meter import children_cpu_s

SOLVER = Path("results/bin/bedFoam")
SETTLE_LINE_STEPS = 5000  # of the particles between two lines of in.settle and in.fill: their `thermo`
ROW_EVERY = 10  # gas steps between two rows of bed_series.csv


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
    print("run_dem: settling the particles without gas", flush=True)
    name = drum.FILL if drum.is_drum(run.case) else "in.settle"
    number = int(read_parameters(run.case / "parameters.lig")["number"])
    with atomic_folder(run.state / run.origin) as part:
        variables = {"decks": DECKS, "parameters": run.case / "parameters.lig", "output": part}
        silence_s = longest_silence(SETTLE_LINE_STEPS * number)
        run_deck(DECKS / name, variables, part / "liggghts.log", run.ranks, silence_s)
        with complete(part):
            check_restart(part / RESTART, number)
        write_record(part, origin_record(run))


def origin_record(run: SegmentedRun) -> Segment:
    """Record of the state that a run goes on from, without its files."""
    return Segment(0, run.start_step, run.start_step, run.origin, 0.0, 0.0, 0.0, 0.0)


def run_segment(run: SegmentedRun, index: int, steps: tuple[int, int], follows: str) -> Segment:
    """Advance bed and gas over one segment.

    Parameters
    ----------
    run : SegmentedRun
    index : int
        Of the segment, from 1.
    steps : (int, int)
        First and last step of the particles.
    follows : str
        Hash of the state that it goes on from.

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
    name = f"segment_{index:04d}"
    previous = run.state / (f"segment_{index - 1:04d}" if index > 1 else run.origin)
    before_s = children_cpu_s()
    with atomic_folder(run.state / name) as part:
        try:
            simulate = drum.simulate if drum.is_drum(run.case) else _simulate_bed
            spent = simulate(run, part, steps, previous, parameters)
        except UserError as error:
            raise UserError(f"{error}\nlast good state: {previous / RESTART}") from None
        with complete(part):
            check_state(run, part, steps[1], parameters)
        cpu_s = round(children_cpu_s() - before_s, 3)
        segment = Segment(index, *steps, name, *spent, follows, cpu_s=cpu_s)
        return write_record(part, segment)


def _simulate_bed(
    run: SegmentedRun,
    part: Path,
    steps: tuple[int, int],
    previous: Path,
    parameters: Mapping[str, float | str],
) -> tuple[float, float, float, float]:
    """Run bedFoam over a segment; returns wall time, and its shares in particles, exchange and gas [s]."""
    step_s = float(parameters["dem_step"])
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
    # bedFoam writes a line at least every other second, or after each gas step where that is longer
    silence_s = longest_silence(float(parameters["number"]) * float(parameters["coupling_steps"]))
    run_logged(on_ranks(command, run.ranks), part / "bedFoam.log", progress, silence_s=silence_s)
    with complete(part):
        row_s = ROW_EVERY * float(parameters["coupling_steps"]) * step_s
        keep_own_frames(part, run, steps, parameters)
        check_series(part / "gas" / SERIES, (steps[0] * step_s, steps[1] * step_s), row_s)
        if not progress.totals:
            raise DataError(f"{part / 'bedFoam.log'} lacks the totals of bedFoam's last line")
    spent = progress.totals
    return spent["wall"], spent["dem"], spent["exchange"], spent["gas"]


def check_state(
    run: SegmentedRun, folder: Path, end_step: int, parameters: Mapping[str, float | str]
) -> None:
    """Refuse a restart or gas fields that are not complete.

    Raises
    ------
    DataError
        Names the file and what is wrong.
    """
    check_restart(folder / RESTART, int(parameters["number"]))
    if not drum.is_drum(run.case):
        check_gas(folder / "gas", run.ranks, end_step * float(parameters["dem_step"]))
