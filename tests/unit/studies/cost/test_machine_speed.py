# SPDX-License-Identifier: GPL-3.0-or-later
"""Seconds that solvers and jobs take, and this machine's speed out of made-up runs."""

import math

import numpy as np
import pytest

from bedchain.studies.cost import machine_speed
from bedchain.studies.cost.machine_speed import BedSize
from made.cost_runs import PAPER, write_run


def test_solver_by_hand_and_near_what_was_measured():
    found = machine_speed.solver_seconds(PAPER, 1.0, cores=2)
    assert found["dem"] == pytest.approx(81000 * (32000 / 7.1e6 + 1.9e-3) / 2)
    assert found["exchange"] == pytest.approx(2000 * 81000 / (2 * 9.4e6))
    assert found["gas"] == pytest.approx(2000 * (0.9e-3 + 1.2e-6 * 11340 / 2))
    # 301 s a simulated second on two ranks, 577 s on one (results/peers), when the gas took 15 and 26 s more
    assert sum(found.values()) == pytest.approx(301 - 15, rel=0.05)
    alone = BedSize(81000, 1, 11340, 3.125e-5, 5e-4)
    by_one = machine_speed.solver_seconds(alone, 1.0, cores=2)
    assert sum(by_one.values()) == pytest.approx(577 - 26, rel=0.05)


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
