# SPDX-License-Identifier: GPL-3.0-or-later
"""The codes that are installed on one tiny bed in motion: they agree, and nothing is run twice."""

import pytest

from bedchain.peers.bed import fluidized_bed
from bedchain.peers.study import all_peers, missing, run_in_turns
from bedchain.peers.table import summary

PARTICLES = 300
START, DURATION = 0.03, 0.004  # [s]: past the ramp of the tiny bed; 200 steps of the particles
SAME_HEIGHT = 2e-3  # of the mean height: 0.05 diameters or so
SAME_DROP = 0.15  # DPMFoam does not smooth the voidage, whose cells hold some 25 particles
SAME_RANKS = 1e-6


def test_all_codes_agree_on_the_tiny_bed(make_bed, solver, tmp_path):
    make_bed("tiny")
    bed = fluidized_bed(tmp_path / "tiny.yaml", tmp_path / "bed", solver, START)
    assert len(bed.particles) == PARTICLES and abs(bed.particles[:, 3]).max() > 0.01
    peers, said = all_peers(solver), []
    runs = run_in_turns(bed, peers, tmp_path, 1, DURATION, 75.0, said.append)
    table = summary(runs, {bed.name: bed}, peers).set_index("code")

    absent = [peer.name for peer in peers if missing(peer)]
    assert {*absent} <= {"LAMMPS GRANULAR", "Yade"}
    assert all("not installed" in table.loc[name, "note"] for name in absent)
    done = table.drop(index=absent)
    assert (done["note"] == "").all() and (done["particles"] == PARTICLES).all()
    assert done["dem_step_s"].tolist() == pytest.approx([bed.value("dem_step")] * len(done), rel=0.05)
    assert (done["wall_s_per_simulated_s"] > 0).all()

    height, drop = done["mean_height_m"], done["pressure_drop_per_weight_1"]
    assert height["bedFoam, 2 ranks"] == pytest.approx(height["bedFoam"], rel=SAME_RANKS)
    assert height["DPMFoam"] == pytest.approx(height["bedFoam"], rel=SAME_HEIGHT)
    assert drop["DPMFoam"] == pytest.approx(drop["bedFoam"], rel=SAME_DROP)
    # without gas the bed falls: all codes of particles alone agree, and the gas makes a difference to see
    alone = height.drop(["bedFoam", "bedFoam, 2 ranks", "DPMFoam"])
    assert alone.tolist() == pytest.approx([height["LIGGGHTS"]] * len(alone), rel=1e-4)
    assert height["bedFoam"] > height["LIGGGHTS"] * (1 + SAME_HEIGHT)

    records = {file: file.stat().st_mtime_ns for file in (tmp_path / bed.name / "runs").iterdir()}
    run_in_turns(bed, peers, tmp_path, 1, DURATION, 75.0, said.append)
    fluidized_bed(tmp_path / "tiny.yaml", tmp_path / "bed", solver, START)
    assert records == {file: file.stat().st_mtime_ns for file in (tmp_path / bed.name / "runs").iterdir()}
    assert len(records) == len(done)
