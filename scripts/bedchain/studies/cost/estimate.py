# SPDX-License-Identifier: GPL-3.0-or-later
"""Estimated cost of each stage of a case and expected errors of its chains, from the case alone."""

import math
from collections.abc import Iterable
from dataclasses import replace

import pandas as pd

from bedchain.case.parcels import parcel_case
from bedchain.case.presets import Preset, with_preset
from bedchain.case.schema import Case
from bedchain.dem import disk
from bedchain.dem.memory import solver_bytes
from bedchain.dem.repeats import repeat_ranks, repeats_at_once
from bedchain.errors import CaseError
from bedchain.meter import BYTES_IN_MB
from bedchain.physics.whole_numbers import ratio
from bedchain.studies.cost import machine_speed
from bedchain.studies.cost.machine_speed import SOLVERS, BedSize, Speed

PREDICTED = ["wall_s", "memory_mb", "disk_mb", "error_floors"]
Numbers = dict[str, float]


def predicted(
    case: Case, speed: Speed, presets: Iterable[Preset] = (), archived: bool = False
) -> pd.DataFrame:
    """Estimated cost of each stage alone on an idle machine, without figures and diagnostics.

    Parameters
    ----------
    case : dict
        A checked case.
    speed : Speed
        Of this machine.
    presets : iterable of Preset
        With measured errors.
    archived : bool
        Whether the bed comes from an archive, so that nothing is simulated.

    Returns
    -------
    DataFrame
        Indexed by stage: wall_s, memory_mb, disk_mb, error_floors; NaN where unknown.
    """
    case = parcel_case(case)
    rows = {} if archived else solver_stages(case, speed)
    frames, number = _frames(case, case["time"]["end_s"]), case["particles"]["number"]
    repeats = case["comparison"]["repeats"]
    window_s = case["comparison"]["end_s"] - case["comparison"]["start_s"]
    if not archived:
        parsed = [number * frames, *[number * _frames(case, window_s)] * repeats]
        costs = [_job("parse_dumps", work, speed) for work in parsed]
        rows["parse_dumps"] = {
            "wall_s": sum(cost["wall_s"] for cost in costs),
            "memory_mb": max(cost["memory_mb"] for cost in costs),
            "disk_mb": sum(parsed) * disk.TRAJECTORY_BYTES / BYTES_IN_MB,
        }
    cells_mb = number * frames * disk.CELL_BYTES / BYTES_IN_MB
    rows["assign_cells"] = _job("assign_cells", number * frames, speed) | {"disk_mb": cells_mb}
    learn_s = case["learning"]["end_s"] - case["learning"]["start_s"]
    moves = number * (_frames(case, learn_s) - 1)
    for model in case["chain"]["models"]:
        rows[f"build_transitions_{model}"] = _job(f"build_transitions_{model}", moves, speed)
        error = {"error_floors": error_of(case, model, presets)}
        rows[f"run_chain_{model}"] = _job(f"run_chain_{model}", moves, speed) | error
    return pd.DataFrame.from_dict(rows, orient="index").reindex(columns=PREDICTED)


def solver_stages(case: Case, speed: Speed) -> dict[str, Numbers]:
    """Rows of settling, particles, exchange, gas, start-ups and repeats."""
    bed, time = machine_speed.bed_of(case), case["time"]
    window_s = case["comparison"]["end_s"] - case["comparison"]["start_s"]
    parts = solver_wall(bed, time["end_s"], speed)
    settling = machine_speed.settling_seconds(bed, time["settle_s"]) / speed.dem
    rows: dict[str, Numbers] = {"settling": {"wall_s": settling}}
    for name in SOLVERS if bed.gas_cells else SOLVERS[:1]:
        rows[name] = {"wall_s": parts[name]}
    memory_mb = solver_bytes(bed.number, bed.ranks) / BYTES_IN_MB
    rows["dem"] |= {"memory_mb": memory_mb, "disk_mb": run_disk(case, bed, time["end_s"])}
    rows["segment_starts"] = {
        "wall_s": _segments(case, time["end_s"]) * machine_speed.SEGMENT_START_S / speed.jobs
    }
    if repeats := case["comparison"]["repeats"]:
        one = replace(bed, ranks=repeat_ranks(bed.ranks, repeats))
        starts = _segments(case, window_s) * machine_speed.SEGMENT_START_S / speed.jobs
        wall = sum(solver_wall(one, window_s, speed).values()) + starts
        rows["repeats"] = {
            "wall_s": repeats * wall / repeats_at_once(one.ranks, repeats),
            "memory_mb": solver_bytes(one.number, one.ranks) / BYTES_IN_MB,
            "disk_mb": repeats * run_disk(case, bed, window_s),
        }
    return rows


def solver_wall(bed: BedSize, span_s: float, speed: Speed, cores: int | None = None) -> Numbers:
    """Wall time of each part of the solver for a span of simulated time, on this machine [s]."""
    expected = machine_speed.solver_seconds(bed, span_s, cores)
    return {name: wall / getattr(speed, name) for name, wall in expected.items()}


def run_disk(case: Case, bed: BedSize, span_s: float) -> float:
    """Size of the frames and restarts of a span of simulated time [MB]."""
    frame = bed.number * disk.DUMP_COLUMNS[case["bed"]["layers"]] * disk.DOUBLE_BYTES
    restart = bed.number * disk.RESTART_BYTES_PARTICLE + bed.gas_cells * disk.RESTART_BYTES_GAS_CELL
    return (_frames(case, span_s) * frame + (_segments(case, span_s) + 1) * restart) / BYTES_IN_MB


def error_of(case: Case, model: str, presets: Iterable[Preset]) -> float:
    """Measured error of the preset with the chain of the case, in noise floors; NaN without one."""
    for preset in presets:
        try:
            same = with_preset(case, preset)
        except CaseError:
            continue
        if preset.model == model and all(
            same[section][key] == case[section][key]
            for section, key in (("cells", "columns"), ("cells", "rows"), ("chain", "lag_s"))
        ):
            return preset.error_floors
    return math.nan


def _job(name: str, work: float, speed: Speed) -> Numbers:
    wall_s, memory_mb = machine_speed.job_cost(name, work)
    return {"wall_s": wall_s / speed.jobs, "memory_mb": memory_mb}


def _frames(case: Case, span_s: float) -> int:
    return int(ratio(span_s, case["time"]["frame_interval_s"])) + 1


def _segments(case: Case, span_s: float) -> int:
    return math.ceil(ratio(span_s, case["time"]["segment_s"]))
