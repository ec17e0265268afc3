# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run took, beside its estimate."""

import json
import math

import pandas as pd
import pytest

from bedchain.studies.cost import machine_speed
from bedchain.studies.cost.actual import (
    FACTOR_AIM,
    TOTAL,
    actual_cost,
    actual_error,
    beside_actual,
    far_from_estimate,
    settling_loop,
)
from bedchain.studies.cost.estimate import predicted
from bedchain.studies.cost.machine_speed import Speed
from made.cost_runs import write_run

LIKE = Speed(1, 1, 1, 1, "the reference itself")


@pytest.fixture
def results(tmp_path, short):
    """Results of a short bed of which two fifths have been simulated, 1.2 times as long as estimated."""
    bed = machine_speed.bed_of(short)
    usual = machine_speed.solver_seconds(bed, 1.0)
    slower = {name: 1.2 * usual[name] for name in machine_speed.SOLVERS}
    write_run(tmp_path / "bed", slower, bed, ((0, 1.0), (1.0, 2.0)), (20, 1, 80))
    return tmp_path / "bed"


def folders(results):
    return {"bed": results / "benchmarks", "made": results / "benchmarks"}


def test_what_happened_is_set_against_the_part_that_was_done(short, results):
    table = beside_actual(predicted(short, LIKE), actual_cost(short, results, results, folders(results)))
    for name in machine_speed.SOLVERS:
        assert table.loc[name, "done_1"] == pytest.approx(0.4)
        assert table.loc[name, "ratio_1"] == pytest.approx(1.2)
    assert table.loc[TOTAL, "ratio_1"] == pytest.approx(1.2)
    assert table.loc[TOTAL, "wall_s"] == pytest.approx(table["wall_s"].drop(TOTAL).sum())
    assert table.loc[["settling", "repeats", "parse_dumps"], "ratio_1"].isna().all()
    assert far_from_estimate(table) == []


def test_jobs_settling_repeats_and_errors_that_happened(short, results):
    (results / "benchmarks").mkdir()
    header, row = "s\tmax_rss\n", "{}\t{}\n"
    for job, seconds in (("run_dem", 9), ("parse_dumps", 2.5), ("run_chain_static", 1.0)):
        (results / "benchmarks" / f"{job}.tsv").write_text(header + row.format(seconds, 111))
    (results / "dem/stamp/settled").mkdir()
    log = "Step\nLoop time of 12.5 on 2 procs for 15000 steps with 9000 atoms\n"
    (results / "dem/stamp/settled/liggghts.log").write_text(log)
    (results / "trajectory.npy").write_bytes(b"x" * 1000)
    write_run(results / "repeats/1", {"dem": 20.0, "exchange": 1, "gas": 4}, spans=((3.5, 5.0),))
    found = actual_cost(short, results, results, folders(results))
    assert found.loc["settling", "happened_wall_s"] == 12.5
    assert found.loc["dem", "happened_memory_mb"] == 111
    assert found.loc["parse_dumps", "happened_disk_mb"] == pytest.approx(1e-3)
    assert found.loc["repeats", ["happened_wall_s", "done_1"]].tolist() == pytest.approx([37.5, 1 / 3])
    manifest = json.loads((results / "repeats/1/dem.json").read_text())
    (results / "repeats/1/dem.json").write_text(json.dumps(manifest | {"ranks": 1}))
    beside = actual_cost(short, results, results, folders(results))
    assert beside.loc["repeats", "happened_wall_s"] == pytest.approx(18.75)  # another one had the other core
    assert found.loc["run_chain_static", "done_1"] == 1
    assert "build_transitions_static" not in found.index


def test_nothing_has_happened_yet(short, tmp_path):
    table = beside_actual(predicted(short, LIKE), actual_cost(short, tmp_path, tmp_path, folders(tmp_path)))
    assert table["ratio_1"].isna().all() and table.loc[TOTAL, "wall_s"] > 0


def test_stages_outside_the_factor_are_named():
    ratios = [1 / 1.6, 1 / 1.4, 1.4, 1.6, math.nan]
    table = pd.DataFrame({"ratio_1": ratios}, index=["fast", "a", "b", "slow", "unknown"])
    assert FACTOR_AIM == 1.5 and far_from_estimate(table) == ["fast", "slow"]


def test_the_time_of_settling_is_in_liggghts_s_log(tmp_path):
    log = tmp_path / "liggghts.log"
    assert settling_loop(log) is None
    log.write_text("Setting up run\nkilled")
    assert settling_loop(log) is None


def test_errors_in_noise_floors_by_hand(tmp_path, short):
    file = tmp_path / "metrics.csv"
    rows = [(f"noise_floor_{group}", "dem", 0.1) for group in ("left", "right", "low", "up")]
    rows += [("error_rms_left", "static", 0.3), ("error_rms_right", "static", 0.1)]
    rows += [("error_rms_low", "static", 0.1), ("error_rms_up", "static", 0.1)]
    pd.DataFrame(rows, columns=["quantity", "source", "value"]).to_csv(file, index=False)
    assert actual_error(file, "static") == pytest.approx(math.sqrt((9 + 1 + 1 + 1) / 4))
    assert math.isnan(actual_error(file, "dynamic"))
    assert math.isnan(actual_error(tmp_path / "none.csv", "static"))
    found = actual_cost(short, tmp_path, tmp_path, folders(tmp_path))
    assert found.loc["run_chain_static", "happened_error_floors"] == pytest.approx(math.sqrt(3))
