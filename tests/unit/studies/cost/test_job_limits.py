# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits of a cluster's jobs: above the estimate, growing with the bed, more memory in each try."""

from pathlib import Path

import pytest

from bedchain.case.load import load_case
from bedchain.dem.memory import solver_bytes
from bedchain.studies.cost.estimate import predicted
from bedchain.studies.cost.job_limits import (
    LEAST_MB,
    LEAST_MIN,
    TIME_MARGIN,
    job_limits,
    shortest_useful_minutes,
)
from bedchain.studies.cost.machine_speed import Speed, bed_of
from made import ROOT


@pytest.fixture(scope="module", params=["short", "paper"])
def case(request):
    return load_case(ROOT / Path("cases") / request.param / "case.yaml")


def test_limits_hold_the_estimate_with_its_margin(case, monkeypatch):
    cores = set(range(bed_of(case).ranks))  # of a node that has what the bed asks for
    monkeypatch.setattr("os.sched_getaffinity", lambda process: cores)
    stages = ["settling", "dem", "exchange", "gas", "segment_starts"]
    wall_s = predicted(case, Speed(1, 1, 1, 1, ""))["wall_s"][stages].sum()
    limit = job_limits(case)["bed"]["runtime"]
    assert limit - LEAST_MIN == pytest.approx(TIME_MARGIN * wall_s / 60, abs=1.01)


def test_a_repeat_gets_less_and_a_variant_on_one_rank_more_time_than_the_run(case):
    limits = job_limits(case)
    assert limits["repeat"]["runtime"] <= limits["bed"]["runtime"] <= limits["variant"]["runtime"]


def test_each_try_gets_more_memory_and_the_first_is_above_the_need(case):
    memory = job_limits(case)["bed"]["mem_mb"]
    assert memory(None, attempt=1) >= max(solver_bytes(case["particles"]["number"], 2) / 1e6, LEAST_MB)
    assert memory(None, attempt=3) == 3 * memory(None, attempt=1)


def test_a_job_must_settle_the_bed_or_finish_a_segment(case):
    whole = shortest_useful_minutes(case, "run_dem")
    case = case | {"time": case["time"] | {"segment_s": 100.0}}
    assert shortest_useful_minutes(case, "run_dem") > 10 * whole
    case = case | {"time": case["time"] | {"settle_s": 1e4}}
    assert shortest_useful_minutes(case, "run_dem") > 2 * shortest_useful_minutes(case, "repeat_dem")
