# SPDX-License-Identifier: GPL-3.0-or-later
"""Speed of the solvers and jobs on the reference machine, and of this machine relative to it.

Reference: the short and the paper's bed on two shared cores of an AMD EPYC, otherwise idle. Another machine
is faster or slower by one factor for each solver, taken from runs of other cases on it or, without any, from
a probe of the processor.
"""

import json
import os
import time
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bedchain.case.parcels import parcel_case
from bedchain.case.rank_checks import most_ranks
from bedchain.case.schema import Case
from bedchain.dem.segments import read_parameters
from bedchain.files import path_inside
from bedchain.physics.whole_numbers import ratio

SOLVERS = ("dem", "exchange", "gas")
# Particle steps per second [1/s] of a rank, by its number of particles [1]: in a bubbling bed, and settling
MOVING = ((4500, 12e6), (40500, 7.1e6), (81000, 7.3e6))
# lists of neighbours, for each particle and simulated second [s]: made anew by distance, whatever the step
LISTS_S = 1.9e-3
SETTLING = ((4500, 6.2e6), (81000, 4.6e6))
EXCHANGED = 9.4e6  # particles mapped to the gas cells and back per second [1/s], of a rank
GAS_STEP_S = 0.9e-3  # of a step of the gas with few cells [s]
GAS_CELL_S = 1.2e-6  # added for each cell of a rank [s]
SEGMENT_START_S = 0.8  # of a segment: start of the programs, mesh, restart and frames [s]


class Job(NamedTuple):
    """A job measured from its start to its end.

    Attributes
    ----------
    work : float
        Particles times frames, or times steps of the learning window [1].
    wall_s : float
        [s].
    memory_mb : float
        Peak of the resident memory [MB].
    """

    work: float
    wall_s: float
    memory_mb: float


# Of the short bed, and of the first 5.5 s of the paper's bed (parsing, cells, learning) or all of its windows
# (running the chains, each learned five times more for its error bars), with cells of ten diameters; the
# chosen chain, and running the dynamic one, by their ratio to the static chain beside them on another machine
JOBS: dict[str, tuple[Job, Job]] = {
    "parse_dumps": (Job(1_989_000, 0.58, 70), Job(17_901_000, 3.90, 83)),
    "assign_cells": (Job(1_989_000, 0.40, 90), Job(17_901_000, 0.55, 125)),
    "build_transitions_static": (Job(720_000, 0.83, 205), Job(8_100_000, 1.00, 267)),
    "run_chain_static": (Job(720_000, 1.3, 217), Job(16_200_000, 3.5, 480)),
    "build_transitions_dynamic": (Job(720_000, 0.87, 211), Job(8_100_000, 1.51, 327)),
    "run_chain_dynamic": (Job(720_000, 1.4, 256), Job(16_200_000, 7.5, 569)),
    "build_transitions_chosen": (Job(720_000, 1.0, 242), Job(16_200_000, 1.5, 482)),
    "run_chain_chosen": (Job(720_000, 1.4, 245), Job(16_200_000, 2.5, 501)),
}

PROBE_PARTICLES, PROBE_PAIRS, PROBE_ROUNDS = 20_000, 60_000, 40
PROBE_REFERENCE_S = 4.5e-3  # processor time of a round on the reference machine


@dataclass(frozen=True)
class BedSize:
    """Size of a bed, on which the cost of its simulation depends.

    Attributes
    ----------
    number, ranks, gas_cells : int
        Particles, MPI ranks, cells of the gas [1]; no cells where there is no gas.
    dem_step_s, gas_step_s : float
        Steps of the particles, and of gas and exchange [s].
    """

    number: int
    ranks: int
    gas_cells: int
    dem_step_s: float
    gas_step_s: float


@dataclass(frozen=True)
class Speed:
    """Speed of this machine over the reference machine [1], and its source.

    Attributes
    ----------
    dem, exchange, gas, jobs : float
        Speed of the parts of the solver, and of everything else [1].
    source : str
        One phrase.
    """

    dem: float
    exchange: float
    gas: float
    jobs: float
    source: str


def bed_of(case: Case) -> BedSize:
    """Size of the bed of a checked case, in the parcels that are simulated."""
    case = parcel_case(case)
    bed, time_, cell = case["bed"], case["time"], case["gas"]["cell_size_m"]
    deep = max(1, round(bed["thickness_m"] / cell)) if bed["layers"] == "many" else 1
    cells = int(ratio(bed["width_m"], cell) * ratio(bed["height_m"], cell)) * deep
    coupled = case["gas"]["model"] != "none"
    number, ranks = case["particles"]["number"], most_ranks(case)
    return BedSize(number, ranks, cells if coupled else 0, time_["dem_step_s"], time_["gas_step_s"])


def solver_seconds(bed: BedSize, span_s: float, cores: int | None = None) -> dict[str, float]:
    """Wall time of each part of the solver on the reference machine, for a span of simulated time.

    Parameters
    ----------
    bed : BedSize
    span_s : float
        [s].
    cores : int, optional
        Shared by the ranks; by default all of this machine.

    Returns
    -------
    dict
        dem, exchange, gas [s].
    """
    at_once = min(bed.ranks, cores or len(os.sched_getaffinity(0)))
    a_second = 1 / (bed.dem_step_s * per_rank(MOVING, bed)) + LISTS_S  # for each particle [s]
    dem = bed.number * span_s * a_second / at_once
    if not bed.gas_cells:
        return {"dem": dem, "exchange": 0.0, "gas": 0.0}
    steps = span_s / bed.gas_step_s
    exchange = steps * bed.number / (at_once * EXCHANGED)
    return {
        "dem": dem,
        "exchange": exchange,
        "gas": steps * (GAS_STEP_S + GAS_CELL_S * bed.gas_cells / at_once),
    }


def settling_seconds(bed: BedSize, span_s: float, cores: int | None = None) -> float:
    """Wall time of settling on the reference machine [s]; arguments as `solver_seconds`."""
    at_once = min(bed.ranks, cores or len(os.sched_getaffinity(0)))
    return bed.number * span_s / bed.dem_step_s / (at_once * per_rank(SETTLING, bed))


def per_rank(measured: tuple[tuple[float, float], ...], bed: BedSize) -> float:
    """Particle steps per second of a rank, interpolated between measured beds, constant beyond them [1/s]."""
    sizes, rates = np.array(measured).T
    return float(np.interp(np.log(bed.number / bed.ranks), np.log(sizes), rates))


def job_cost(name: str, work: float) -> tuple[float, float]:
    """Wall time [s] and memory [MB] of a job on the reference machine, by a line through two measurements.

    Parameters
    ----------
    name : str
        A job of `JOBS`.
    work : float
        As there.

    Returns
    -------
    wall_s, memory_mb : float
        NaN for a job that was not measured.
    """
    if name not in JOBS:
        return np.nan, np.nan
    small, large = JOBS[name]
    part = (work - small.work) / (large.work - small.work)
    wall_s = small.wall_s + part * (large.wall_s - small.wall_s)
    memory_mb = small.memory_mb + part * (large.memory_mb - small.memory_mb)
    return max(0.0, wall_s), max(0.0, memory_mb)


def simulated_here(dem: Path) -> dict[str, Any] | None:
    """Manifest of a run whose segments are here; None for a run from an archive, timed elsewhere."""
    try:
        manifest = json.loads(dem.read_text(encoding="utf-8"))
        here = path_inside(dem.parent, manifest["segments"][0]["folder"]).exists()
    except (OSError, ValueError, KeyError, IndexError):
        return None
    return dict(manifest) if here else None


def calibrate(runs: Iterable[Path], bed: BedSize) -> Speed:
    """Speed of this machine, by the run of the other case nearest in size, or by a probe.

    Parameters
    ----------
    runs : iterable of Path
        ``dem.json`` of other cases.
    bed : BedSize
        To be estimated.

    Returns
    -------
    Speed
    """
    jobs = probe_speed()
    known = [(dem, manifest) for dem in runs if (manifest := simulated_here(dem))]
    if not known:
        return Speed(jobs, jobs, jobs, jobs, f"a probe of the processor, {jobs:.2f} of the reference machine")
    dem, manifest = min(known, key=lambda item: abs(np.log(item[1]["number"] / bed.number)))
    given = read_parameters(dem.parent / "parameters.lig")
    cells = int(np.prod([float(given[f"gas_cells_{axis}"]) for axis in "xyz"]))
    spent = {name: sum(segment[f"{name}_s"] for segment in manifest["segments"]) for name in SOLVERS}
    like = BedSize(
        manifest["number"], manifest["ranks"], cells if spent["gas"] else 0,
        float(given["dem_step"]), float(given["gas_step"]),
    )  # fmt: skip
    span_s = sum(segment["end_s"] - segment["start_s"] for segment in manifest["segments"])
    wanted = solver_seconds(like, span_s)
    factors = {name: wanted[name] / spent[name] if spent[name] else jobs for name in SOLVERS}
    about = f"the run of {dem.parent.name} (particles at {factors['dem']:.2f}, gas at {factors['gas']:.2f}"
    return Speed(**factors, jobs=jobs, source=f"{about} of the reference machine's speed)")


def probe_speed() -> float:
    """Speed of this processor over the reference [1], by passes over pairs of particles as in a DEM.

    It is the processor time of the fastest pass, which other programs hardly change.
    """
    rng = np.random.default_rng(1)
    places = rng.random((PROBE_PARTICLES, 2))
    first = np.sort(rng.integers(0, PROBE_PARTICLES, PROBE_PAIRS))
    second = (first + rng.integers(1, 200, PROBE_PAIRS)) % PROBE_PARTICLES
    spent = []
    for _ in range(PROBE_ROUNDS):
        begin = time.process_time()
        pair_forces(places, first, second)
        spent.append(time.process_time() - begin)
    return PROBE_REFERENCE_S / min(spent)


def pair_forces(
    places: NDArray[np.float64], first: NDArray[np.int64], second: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Sum of Hertz-like forces on each particle, (n, 2), of pairs of particles."""
    apart = places[first] - places[second]
    distance = np.sqrt((apart**2).sum(axis=1)) + 1e-12
    force = (np.maximum(0.0, 1.0 - distance) ** 1.5 / distance)[:, None] * apart
    return np.stack(
        [
            np.bincount(first, force[:, axis], len(places)) - np.bincount(second, force[:, axis], len(places))
            for axis in range(2)
        ],
        axis=1,
    )
