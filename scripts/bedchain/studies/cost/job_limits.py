# SPDX-License-Identifier: GPL-3.0-or-later
"""Time and memory that a case's jobs ask of a cluster, from the estimate of its cost."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from bedchain.case.schema import Case
from bedchain.dem.memory import memory_needs, solver_bytes
from bedchain.dem.repeats import repeat_ranks
from bedchain.meter import BYTES_IN_MB
from bedchain.studies.cost.machine_speed import (
    SEGMENT_START_S,
    BedSize,
    bed_of,
    settling_seconds,
    solver_seconds,
)

# Over the estimate, which is of an idle machine as fast as the reference. A job that ends at its limit goes
# on from its last segment in the next try; one that ran out of memory gets more in it.
TIME_MARGIN, MEMORY_MARGIN = 3.0, 2.0
LEAST_MIN, LEAST_MB = 10, 1000
Resources = dict[str, int | Callable[..., int]]


def job_limits(case: Case) -> dict[str, Resources]:
    """Resources of the rules whose cost depends on the size of the bed, for Snakemake.

    Parameters
    ----------
    case : dict
        A checked case of a bed.

    Returns
    -------
    dict of str to dict
        ``runtime`` [min] and ``mem_mb`` [MB] by ``bed`` (the run), ``repeat``, ``variant`` (on one rank);
        ``mem_mb`` by ``chains`` (each job that learns them).
    """
    bed, time, compared = bed_of(case), case["time"], case["comparison"]
    repeated = replace(bed, ranks=repeat_ranks(bed.ranks, compared["repeats"]))
    alone = replace(bed, ranks=1)
    return {
        "bed": _limits(_run_seconds(bed, case, time["end_s"]), solver_bytes(bed.number, bed.ranks)),
        "repeat": _limits(
            _run_seconds(repeated, case, compared["end_s"] - compared["start_s"]),
            solver_bytes(bed.number, repeated.ranks),
        ),
        "variant": _limits(_run_seconds(alone, case, time["end_s"]), solver_bytes(bed.number, 1)),
        "chains": {"mem_mb": _memory(memory_needs(case)["learning the chains"])},
    }


def shortest_useful_minutes(case: Case, rule: str) -> float:
    """Estimated time of what a job of a rule must finish at once, since it goes on only from there [min].

    Parameters
    ----------
    case : dict
        A checked case of a bed.
    rule : {"run_dem", "repeat_dem"}
        The first settles the bed in one go.
    """
    bed, time = bed_of(case), case["time"]
    if rule == "repeat_dem":
        bed = replace(bed, ranks=repeat_ranks(bed.ranks, case["comparison"]["repeats"]))
    segment_s = sum(solver_seconds(bed, time["segment_s"], bed.ranks).values())
    settling_s = settling_seconds(bed, time["settle_s"], bed.ranks) if rule == "run_dem" else 0.0
    return (max(segment_s, settling_s) + SEGMENT_START_S) / 60


def _run_seconds(bed: BedSize, case: Case, span_s: float) -> float:
    segments = math.ceil(span_s / case["time"]["segment_s"])
    settling_s = settling_seconds(bed, case["time"]["settle_s"], bed.ranks)
    return settling_s + sum(solver_seconds(bed, span_s, bed.ranks).values()) + segments * SEGMENT_START_S


def _limits(wall_s: float, memory_bytes: float) -> Resources:
    return {"runtime": LEAST_MIN + math.ceil(TIME_MARGIN * wall_s / 60), "mem_mb": _memory(memory_bytes)}


def _memory(memory_bytes: float) -> Callable[..., int]:
    memory_mb = max(LEAST_MB, math.ceil(MEMORY_MARGIN * memory_bytes / BYTES_IN_MB))

    def more_each_time(wildcards: Any, attempt: int) -> int:
        return memory_mb * attempt

    return more_each_time
