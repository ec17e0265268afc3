# SPDX-License-Identifier: GPL-3.0-or-later
"""The codes that are installed on one tiny bed in motion: they agree, and nothing is run twice."""

from dataclasses import replace

import numpy as np
import pytest

from bedchain.studies.peers import dpmfoam
from bedchain.studies.peers.bed import fluidized_bed, with_numbers
from bedchain.studies.peers.study import all_peers, missing, run_in_turns
from bedchain.studies.peers.table import summary
from bedchain.studies.verification.laws import Suspension, ergun_gradient

PARTICLES = 300
START, DURATION = 0.03, 0.004  # [s]: past the ramp of the tiny bed; 200 steps of the particles
CELL = 5e-3  # [m], of the gas
NEAR_HEIGHT = 2e-5  # [m], a fiftieth of a diameter, of 6e-4 risen
ALONE_HEIGHT = 5e-6  # [m], between codes of particles alone, whose dashpots differ
SAME_RANKS = 1e-6
NEAR_DROP = 0.05  # the particles have begun to fall


@pytest.fixture
def tiny(make_bed, solver, tmp_path):
    """The tiny bed under gas, rising."""
    make_bed("tiny")
    return fluidized_bed(tmp_path / "tiny.yaml", tmp_path / "bed", solver, START)


def test_all_codes_agree_on_the_tiny_bed(tiny, solver, tmp_path):
    assert len(tiny.particles) == PARTICLES and abs(tiny.particles[:, 3]).max() > 0.01
    peers, said = all_peers(solver), []
    runs = run_in_turns(tiny, peers, tmp_path, 1, DURATION, 75.0, said.append)
    table = summary(runs, {tiny.name: tiny}, peers).set_index("code")

    absent = [peer.name for peer in peers if missing(peer)]
    assert {*absent} <= {"LAMMPS GRANULAR", "Yade"}
    assert all("not installed" in table.loc[name, "note"] for name in absent)
    done = table.drop(index=absent)
    assert (done["note"] == "").all() and (done["particles"] == PARTICLES).all()
    assert done["dem_step_s"].tolist() == pytest.approx([tiny.value("dem_step")] * len(done), rel=0.05)
    assert (done["wall_s_per_simulated_s"] > 0).all()

    height = done["mean_height_m"]
    assert height["bedFoam, 2 ranks"] == pytest.approx(height["bedFoam"], rel=SAME_RANKS)
    assert height["DPMFoam"] == pytest.approx(height["bedFoam"], abs=NEAR_HEIGHT)
    alone = height.drop(["bedFoam", "bedFoam, 2 ranks", "DPMFoam"])
    assert alone.tolist() == pytest.approx([height["LIGGGHTS"]] * len(alone), abs=ALONE_HEIGHT)
    # what the gas lifts is more than the codes differ by
    assert height["bedFoam"] > height["LIGGGHTS"] + 3 * NEAR_HEIGHT

    folder = tmp_path / tiny.name / "runs"
    records = {file: file.stat().st_mtime_ns for file in folder.iterdir()}
    assert len(records) == len(done)
    run_in_turns(tiny, peers, tmp_path, 1, DURATION, 75.0, said.append)
    assert records == {file: file.stat().st_mtime_ns for file in folder.iterdir()}


def test_dpmfoam_has_the_pressure_drop_of_a_lattice(tiny, tmp_path):
    velocity, rows = 0.3, 40
    x, z = np.meshgrid(1e-3 * np.arange(20) + 5e-4, 1e-3 * np.arange(rows) + 5e-4)
    still = np.zeros(x.size)
    lattice = replace(
        tiny,
        particles=np.column_stack([x.ravel(), z.ravel(), still, still, still + 1e-3]),
        parameters=with_numbers(tiny.parameters, superficial_velocity=velocity, number=x.size),
    )
    outcome = dpmfoam.run(lattice, tmp_path / "lattice", 0.002)
    gradient = ergun_gradient(Suspension(1e-3, 2600.0, 1.2, 1.8e-5), 1 - np.pi / 6, velocity)
    # its pressure misses the drag of half a cell at the inlet, and at the bed's surface
    assert outcome.pressure_drop == pytest.approx(gradient * (1e-3 * rows - CELL), rel=NEAR_DROP)
    assert outcome.particles == x.size
