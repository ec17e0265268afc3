# SPDX-License-Identifier: GPL-3.0-or-later
"""Medians and ratios of the comparison, and its table."""

from dataclasses import replace

import pytest

from bedchain.studies.peers.study import (
    run_in_turns,
)
from bedchain.studies.peers.table import markdown, ratios, summary
from made.peers import timed_peer


def test_medians_and_ratios_by_hand(bed, tmp_path):
    calls, own = [], tmp_path / "x"
    costs = {"bedFoam": [1.2, 9.0, 1.0], "bedFoam, 2 ranks": [0.8] * 3, "DPMFoam": [12.0, 60.0, 11.0]}
    peers = [timed_peer(name, walls, own, calls, gas=True, particles=81_000) for name, walls in costs.items()]
    runs = run_in_turns(bed, peers, tmp_path, 3, 0.01, 75.0, lambda line: None)
    table = summary(runs, {"box": bed}, peers)
    row = table.set_index("code").loc["bedFoam"]
    assert row["wall_s_per_simulated_s"] == pytest.approx(120)
    assert (row["fastest_s_per_simulated_s"], row["slowest_s_per_simulated_s"]) == pytest.approx((100, 900))
    assert row["particle_steps_per_s"] == pytest.approx(81_000 * 500 / 1.2)
    assert row["pressure_drop_per_weight_1"] == pytest.approx(5.0 / bed.weight_per_area)
    assert table["relative_to_bedfoam_1"].tolist() == pytest.approx([1, 0.8 / 1.2, 10])
    found = ratios(table).set_index("quantity")
    assert found["met"].tolist() == ["yes", "no", "yes", "", ""]
    assert found["value"].tolist() == pytest.approx([0.2 / 1.2, 1.5, 10, 1, 1])
    assert "gas and exchange over DEM, one rank [1] | 0.1667 | <= 0.2 | yes" in markdown(table, ratios(table))
    small = ratios(table.assign(particles=9000))
    assert small["met"].eq("").all() and small["target"].eq("").all()


def test_a_busy_machine_is_told(bed, tmp_path):
    peers = [timed_peer("bedFoam", [1.0], tmp_path / "x", [], gas=True)]
    run = run_in_turns(bed, peers, tmp_path, 1, 0.01, 75.0, lambda line: None)[0]
    quiet = summary([replace(run, others=0.1)], {"box": bed}, peers)
    loud = summary([replace(run, others=0.9)], {"box": bed}, peers)
    assert "other programs" not in markdown(quiet, ratios(quiet))
    assert "other programs were at work during bedFoam" in markdown(loud, ratios(loud))
