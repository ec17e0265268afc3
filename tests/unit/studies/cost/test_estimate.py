# SPDX-License-Identifier: GPL-3.0-or-later
"""The estimate: hand-worked rates, this machine's speed out of made runs, and what happened beside it."""

import math
from dataclasses import replace

import pytest

from bedchain.case.load import load_case
from bedchain.case.presets import Preset
from bedchain.dem import disk
from bedchain.studies.cost import machine_speed
from bedchain.studies.cost.estimate import error_of, predicted, run_disk
from bedchain.studies.cost.machine_speed import Speed
from made import ROOT

LIKE = Speed(1, 1, 1, 1, "the reference itself")
SOLVER_STAGES = ["settling", "dem", "exchange", "gas", "segment_starts", "repeats"]


def test_stages_of_the_short_bed(short):
    table = predicted(short, LIKE)
    jobs = ["parse_dumps", "assign_cells"]
    jobs += [
        f"{job}_{model}"
        for model in ("static", "dynamic", "chosen")
        for job in ("build_transitions", "run_chain")
    ]
    assert list(table.index) == SOLVER_STAGES + jobs
    measured = table["wall_s"].drop(["build_transitions_chosen", "run_chain_chosen"])  # these two were not
    assert measured.gt(0).all() and table.loc["dem", "memory_mb"] > 100
    whole = machine_speed.solver_seconds(machine_speed.bed_of(short), 5.0)
    assert table.loc["gas", "wall_s"] == pytest.approx(whole["gas"])
    on_one_rank = replace(machine_speed.bed_of(short), ranks=1)
    repeat = sum(machine_speed.solver_seconds(on_one_rank, 1.5).values()) + 3 * machine_speed.SEGMENT_START_S
    # two at once on the two cores of the run
    assert table.loc["repeats", "wall_s"] == pytest.approx(3 * repeat / 2)
    assert predicted(short, Speed(2, 2, 2, 2, ""))["wall_s"].sum() == pytest.approx(table["wall_s"].sum() / 2)
    stores = table.loc[["dem", "parse_dumps", "assign_cells"], "disk_mb"].sum() * 1e6
    repeats = 3 * 61 * 9000 * disk.TRAJECTORY_BYTES
    once = short | {"comparison": short["comparison"] | {"repeats": 0}}
    assert stores - repeats == pytest.approx(disk.run_bytes(once) / disk.MARGIN, rel=0.01)


def test_an_archived_bed_and_one_without_gas(short):
    assert not set(predicted(short, LIKE, archived=True).index) & {*SOLVER_STAGES, "parse_dumps"}
    drum = load_case(ROOT / "cases" / "drum" / "case.yaml")
    assert list(predicted(drum, LIKE).index)[:4] == ["settling", "dem", "segment_starts", "parse_dumps"]


def test_frames_and_restarts_on_disk_by_hand(short):
    mb = run_disk(short, machine_speed.bed_of(short), 0.5)
    assert mb * 1e6 == 21 * 9000 * 5 * 8 + 2 * (9000 * 500 + 20 * 80 * 500)


def test_an_error_is_known_where_a_preset_gives_the_same_chain(short):
    own = Preset("own", 0.01, 0.025, "static", error_floors=2.0)
    other = Preset("other", 0.01, 0.05, "static", error_floors=1.0)
    too_long = Preset("too long", 0.01, 2.0, "static", error_floors=3.0)
    assert error_of(short, "static", [too_long, other, own]) == 2.0
    assert math.isnan(error_of(short, "dynamic", [other, own]))
    assert math.isnan(error_of(short, "static", [other]))
    table = predicted(short, LIKE, [own])
    assert table.loc["run_chain_static", "error_floors"] == 2.0 and table["error_floors"].count() == 1
