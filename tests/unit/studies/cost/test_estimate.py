# SPDX-License-Identifier: GPL-3.0-or-later
"""The estimate: hand-worked rates, this machine's speed out of made runs, and what happened beside it."""

import json
import math

import numpy as np
import pandas as pd
import pytest

from bedchain.case.load import load_case
from bedchain.case.presets import Preset
from bedchain.dem import disk
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
from bedchain.studies.cost.estimate import error_of, predicted, run_disk
from bedchain.studies.cost.machine_speed import BedSize, Speed
from made import ROOT

LIKE = Speed(1, 1, 1, 1, "the reference itself")
PAPER = BedSize(81000, 2, 54 * 210, 3.125e-5, 5e-4)
SOLVER_STAGES = ["settling", "dem", "exchange", "gas", "segment_starts", "repeats"]


@pytest.fixture(scope="module")
def short():
    return load_case(ROOT / "cases" / "short" / "case.yaml")


def write_run(folder, seconds, bed=PAPER, spans=((0, 0.5), (0.5, 1.0)), cells=(54, 1, 210)):
    """A run whose solver took so many seconds for each second simulated."""
    segments = []
    for index, (start, end) in enumerate(spans):
        (folder / f"dem/stamp/segment_{index}").mkdir(parents=True)
        spent = {f"{name}_s": seconds[name] * (end - start) for name in machine_speed.SOLVERS}
        segments.append(
            {"start_s": start, "end_s": end, "folder": f"dem/stamp/segment_{index}"}
            | spent
            | {"wall_s": sum(spent.values())}
        )
    manifest = {"number": bed.number, "ranks": bed.ranks, "segments": segments}
    (folder / "dem.json").write_text(json.dumps(manifest))
    numbers = {"dem_step": bed.dem_step_s, "gas_step": bed.gas_step_s}
    numbers |= {f"gas_cells_{axis}": count for axis, count in zip("xyz", cells, strict=True)}
    (folder / "parameters.lig").write_text(
        "".join(f"variable {name} equal {value}  # [x]\n" for name, value in numbers.items())
    )
    return folder / "dem.json"


def test_solver_by_hand_and_near_what_was_measured():
    found = machine_speed.solver_seconds(PAPER, 1.0, cores=2)
    assert found["dem"] == pytest.approx(81000 * 32000 / (2 * 5.0e6))
    assert found["exchange"] == pytest.approx(2000 * 81000 / (2 * 9.4e6))
    assert found["gas"] == pytest.approx(2000 * (1.7e-3 + 2.3e-6 * 11340 / 2))
    # 301 s a simulated second on two ranks, 577 s on one (results/peers)
    assert sum(found.values()) == pytest.approx(301, rel=0.05)
    alone = BedSize(81000, 1, 11340, 3.125e-5, 5e-4)
    assert sum(machine_speed.solver_seconds(alone, 1.0, cores=2).values()) == pytest.approx(577, rel=0.05)


def test_ranks_without_cores_of_their_own_take_turns():
    one, two = (machine_speed.solver_seconds(PAPER, 1.0, cores)["dem"] for cores in (1, 2))
    assert one == pytest.approx(2 * two)
    assert machine_speed.settling_seconds(PAPER, 1.0, 1) == pytest.approx(
        2 * machine_speed.settling_seconds(PAPER, 1.0, 2)
    )


def test_rates_lie_between_those_measured_and_stay_beyond():
    table = ((10, 100.0), (1000, 300.0))
    beds = [BedSize(number, 2, 0, 1e-5, 1e-4) for number in (2, 20, 200, 2000, 20000)]
    assert [machine_speed.per_rank(table, bed) for bed in beds] == pytest.approx([100, 100, 200, 300, 300])


def test_without_gas_only_particles_cost():
    found = machine_speed.solver_seconds(BedSize(1000, 1, 0, 1e-5, 5e-4), 2.0)
    assert found["dem"] > 0 and found["exchange"] == found["gas"] == 0


def test_the_speed_is_that_of_the_run_nearest_in_size(tmp_path):
    usual = machine_speed.solver_seconds(PAPER, 1.0)
    near = write_run(tmp_path / "near", {name: 2 * usual[name] for name in machine_speed.SOLVERS})
    small = BedSize(900, 2, 100, 2e-5, 5e-4)
    far = write_run(tmp_path / "far", machine_speed.solver_seconds(small, 1.0), small, cells=(10, 1, 10))
    speed = machine_speed.calibrate([far, near, tmp_path / "none.json"], PAPER)
    assert (speed.dem, speed.exchange, speed.gas) == pytest.approx((0.5, 0.5, 0.5))
    assert "near" in speed.source and speed.jobs > 0
    assert machine_speed.calibrate([far, near], small).gas == pytest.approx(1.0)


def test_a_run_out_of_an_archive_says_nothing_of_this_machine(tmp_path):
    dem = write_run(tmp_path / "packed", {"dem": 1.0, "exchange": 1.0, "gas": 1.0})
    for folder in (tmp_path / "packed" / "dem" / "stamp").glob("*"):
        folder.rmdir()
    speed = machine_speed.calibrate([dem], PAPER)
    assert "probe" in speed.source and speed.dem == speed.gas == speed.jobs > 0


def test_pair_forces_against_a_loop():
    places = [[0.0, 0.0], [0.5, 0.0], [0.5, 2.0]]
    pairs = [(0, 1), (1, 2)]
    expected = [[0.0, 0.0] for _ in places]
    for one, two in pairs:
        apart = [a - b for a, b in zip(places[one], places[two], strict=True)]
        far = math.hypot(*apart)
        for axis in range(2):
            force = max(0.0, 1 - far) ** 1.5 * apart[axis] / far
            expected[one][axis] += force
            expected[two][axis] -= force
    first, second = np.array(pairs).T
    assert machine_speed.pair_forces(np.array(places), first, second) == pytest.approx(np.array(expected))


def test_a_job_costs_what_the_line_through_two_measured_ones_says(monkeypatch):
    two = (machine_speed.Job(100, 1.0, 50), machine_speed.Job(300, 2.0, 60))
    monkeypatch.setitem(machine_speed.JOBS, "made_up", two)
    assert machine_speed.job_cost("made_up", 200) == pytest.approx((1.5, 55))
    assert machine_speed.job_cost("made_up", 500) == pytest.approx((3.0, 70))
    assert all(math.isnan(value) for value in machine_speed.job_cost("not_measured", 200))


def test_stages_of_the_short_bed(short):
    table = predicted(short, LIKE)
    jobs = ["parse_dumps", "assign_cells"]
    jobs += [
        f"{job}_{model}" for model in ("static", "dynamic") for job in ("build_transitions", "run_chain")
    ]
    assert list(table.index) == SOLVER_STAGES + jobs
    assert table["wall_s"].gt(0).all() and table.loc["dem", "memory_mb"] > 100
    whole = machine_speed.solver_seconds(machine_speed.bed_of(short), 5.5)
    assert table.loc["gas", "wall_s"] == pytest.approx(whole["gas"])
    repeat = (
        sum(machine_speed.solver_seconds(machine_speed.bed_of(short), 2.0).values())
        + 4 * machine_speed.SEGMENT_START_S
    )
    assert table.loc["repeats", "wall_s"] == pytest.approx(3 * repeat)
    assert predicted(short, Speed(2, 2, 2, 2, ""))["wall_s"].sum() == pytest.approx(table["wall_s"].sum() / 2)
    stores = table.loc[["dem", "parse_dumps", "assign_cells"], "disk_mb"].sum() * 1e6
    repeats = 3 * 81 * 9000 * disk.TRAJECTORY_BYTES
    assert stores - repeats == pytest.approx(disk.run_bytes(short) / disk.MARGIN, rel=0.01)


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


@pytest.fixture
def results(tmp_path, short):
    """Results of a short bed of which two fifths have been simulated, 1.2 times as long as estimated."""
    bed = machine_speed.bed_of(short)
    usual = machine_speed.solver_seconds(bed, 1.0)
    slower = {name: 1.2 * usual[name] for name in machine_speed.SOLVERS}
    write_run(tmp_path / "bed", slower, bed, ((0, 1.1), (1.1, 2.2)), (20, 1, 80))
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
    write_run(results / "repeats/1", {"dem": 20.0, "exchange": 1, "gas": 4}, spans=((3.5, 5.5),))
    found = actual_cost(short, results, results, folders(results))
    assert found.loc["settling", "happened_wall_s"] == 12.5
    assert found.loc["dem", "happened_memory_mb"] == 111
    assert found.loc["parse_dumps", "happened_disk_mb"] == pytest.approx(1e-3)
    assert found.loc["repeats", ["happened_wall_s", "done_1"]].tolist() == pytest.approx([50, 1 / 3])
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
