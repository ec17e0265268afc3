# SPDX-License-Identifier: GPL-3.0-or-later
"""The comparison with other codes: constants of their contact laws, their files and logs, the study."""

import math
import os
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from bedchain.case.parameters import Parameter
from bedchain.errors import UserError
from bedchain.studies.peers import bedfoam, dpmfoam, lammps, liggghts
from bedchain.studies.peers.bed import PeerBed, fluidized_bed, with_numbers, write_inputs
from bedchain.studies.peers.peer import Outcome, Peer
from bedchain.studies.peers.plots import draw
from bedchain.studies.peers.study import (
    all_peers,
    busy_time,
    compare,
    duration_for,
    missing,
    record_file,
    run_in_turns,
)
from bedchain.studies.peers.table import markdown, ratios, summary
from made import ROOT

NUMBERS = {
    **{"width": 0.02, "height": 0.06, "thickness": 1e-3, "gas_cells_x": 4, "gas_cells_z": 12},
    **{"diameter": 1e-3, "density": 2600.0, "young": 1.9e6, "poisson": 0.3, "gravity": 9.81},
    **{"gas_step": 5e-4, "dem_step": 2e-5, "coupling_steps": 25},
}
PARTICLES = np.array(
    [[0.0005, 0.0005, 0.0, 0.1, 1e-3], [0.0051, 0.0099, -0.3, 0.4, 1e-3], [0.0195, 0.0305, 0.0, 0.0, 1e-3]]
)
LIGGGHTS_LOG = """Loop time of 9 on 1 procs for 10 steps with 8 atoms, finish time now
    Step    Atoms
Loop time of 1.5 on 1 procs for 250 steps with 9000 atoms, finish time Sun Nov 22 08:59:19 2026
"""
LAMMPS_LOG = """Per MPI rank memory allocation (min/avg/max) = 10.31 | 10.31 | 10.31 Mbytes
Step Atoms KinEng c_height
       0     9000 0.0008832624635 0.06212235678
    2500     9000 0.0008348 0.05601087419
Loop time of 6.45472 on 1 procs for 2500 steps with 9000 atoms
"""


@pytest.fixture
def bed():
    """Three particles in a box of 4 x 12 cells."""
    return PeerBed("box", [Parameter(name, value, "-", "test") for name, value in NUMBERS.items()], PARTICLES)


def code(name, costs, folder, calls, gas=False, fails=False, particles=3):
    """A code that takes the given wall times in turn, and notes its calls."""

    def run(bed, work, duration_s):
        calls.append(name)
        if fails:
            raise UserError(f"{name} has stopped\nits log: somewhere")
        work.mkdir(parents=True)
        wall = costs[calls.count(name) - 1]
        return Outcome(
            duration_s, wall, particles, bed.dem_steps(duration_s), 0.01, *([5.0, wall, 0.1, 0.1] * gas)
        )

    return Peer(name, "sh", "", gas, "", run, 1e-6, (folder,))


def restitution_of(alpha):
    """Speed after over speed before of a Hertz impact with DPMFoam's dashpot, by small steps."""
    mass, stiffness, step = 1.0, 1.0, 1e-5
    overlap, speed = 0.0, 0.01
    start = speed
    while True:
        damping = alpha * math.sqrt(mass * stiffness) * max(overlap, 0.0) ** 0.25
        speed -= step * (stiffness * max(overlap, 0.0) ** 1.5 + damping * speed) / mass
        overlap += step * speed
        if overlap <= 0:
            return -speed / start


@pytest.mark.parametrize("restitution", [0.9, 0.6])
def test_the_dashpot_of_dpmfoam_gives_the_restitution(restitution):
    found = restitution_of(dpmfoam.dashpot(restitution))
    assert found == pytest.approx(restitution, rel=0.005)


def test_an_elastic_impact_has_no_dashpot():
    assert dpmfoam.dashpot(1.0) == 0


@pytest.mark.parametrize("fastest", [0.1, 1.0, 3.0])
def test_dpmfoams_rule_takes_the_step_of_the_bed(bed, fastest):
    # PairSpringSliderDashpot::nSubCycles of OpenFOAM 1912, written out
    young = 1.9e6 / (2 * (1 - 0.3**2))
    collision = 5.429675 * (1e-3 / 4) * (2600 / (young * math.sqrt(2 * fastest))) ** 0.4
    substeps = math.ceil(5e-4 / (collision / dpmfoam.resolution(bed, fastest)))
    assert substeps == 25


def test_tangential_dashpot_is_the_root_of_the_stiffnesses():
    # G* = G / (2 (2 - nu)) and E* = E / (2 (1 - nu^2)), G = E / (2 (1 + nu))
    assert lammps.tangential_dashpot(0.3) ** 2 == pytest.approx(2 * 0.7 / 1.7)


def test_the_last_run_of_a_log_counts(tmp_path):
    log = tmp_path / "log"
    log.write_text(LIGGGHTS_LOG)
    assert liggghts.loop_time(log) == (1.5, 250, 9000)
    log.write_text(LAMMPS_LOG)
    assert liggghts.loop_time(log) == (6.45472, 2500, 9000)
    assert lammps.last_height(log) == 0.05601087419


def test_a_log_that_breaks_off_is_told(tmp_path):
    log = tmp_path / "log"
    log.write_text(LAMMPS_LOG.splitlines()[0])
    with pytest.raises(UserError, match="no finished run"):
        liggghts.loop_time(log)
    with pytest.raises(UserError, match="no table"):
        lammps.last_height(log)
    with pytest.raises(UserError, match="no pressure at the inlet"):
        dpmfoam.inlet_pressure(tmp_path)


def test_dpmfoams_lines_give_sub_steps_and_times():
    report = dpmfoam.Report()
    for line in ["    25 move-collide subCycles\n", "ExecutionTime = 0.1 s  ClockTime = 1 s\n", "Time = 1\n"]:
        report(line)
    assert report.subcycles == [25] and len(report.ends) == 1


def test_the_cloud_names_the_cell_of_each_particle(bed, tmp_path):
    dpmfoam.write_cloud(bed, tmp_path)
    cloud = tmp_path / dpmfoam.CLOUD
    places = re.findall(r"^\((\S+) 0 (\S+)\) (\d+)$", (cloud / "positions").read_text(), re.M)
    # cells of 5 mm, 4 a row: columns 0, 1, 3 of rows 0, 1, 6
    assert [(float(x), float(z), int(cell)) for x, z, cell in places] == [
        (0.0005, 0.0005, 0),
        (0.0051, 0.0099, 5),
        (0.0195, 0.0305, 27),
    ]
    assert "(-0.3 0 0.4)" in (cloud / "U").read_text()
    assert "3(0 1 2)" in (cloud / "origId").read_text()
    assert "4{0}\n0()" in (cloud / "collisionRecordsPairData").read_text()


def test_inputs_hold_the_bed_and_the_numbers_of_the_comparison(bed, tmp_path):
    write_inputs(bed, tmp_path / "case", frame_steps=50, dem_step=1e-5)
    given = (tmp_path / "case" / "parameters.lig").read_text()
    assert "variable dem_step equal 1e-05" in given and "variable frame_steps equal 50" in given
    assert given.count("dem_step") == 1
    assert "3 atoms" in (tmp_path / "case" / "particles.data").read_text()
    assert [item.value for item in with_numbers(bed.parameters, young=1.0) if item.name == "young"] == [1.0]


def test_weight_of_the_bed(bed):
    assert bed.weight_per_area == pytest.approx(3 * 2600 * math.pi / 6 * 1e-9 * 9.81 / 2e-5)


def test_a_slow_code_simulates_less(bed, tmp_path):
    peer = code("slow", [1.0], tmp_path, [])
    # 1e-6 s a particle's step, three particles, 50 000 steps a second: 0.15 s a simulated second
    assert duration_for(peer, bed, 0.02, 75.0) == 0.02
    assert duration_for(peer, bed, 0.02, 0.0015) == pytest.approx(0.01)


def test_codes_take_turns_and_what_is_done_stays_done(bed, tmp_path):
    calls, own = [], tmp_path / "own"
    own.write_text("deck")
    peers = [code(name, [1.0, 3.0, 2.0], own, calls, gas=True) for name in ("a", "b")]
    first = run_in_turns(bed, peers, tmp_path, 2, 0.01, 75.0, lambda line: None)
    assert calls == ["a", "b", "a", "b"]
    again = run_in_turns(bed, peers, tmp_path, 3, 0.01, 75.0, lambda line: None)
    assert calls[4:] == ["a", "b"]
    assert again[:4] == first
    assert not list((tmp_path / "box" / "work").iterdir())


@pytest.mark.parametrize("changed", ["deck", "particles", "number", "duration"])
def test_a_changed_input_makes_a_run_of_its_own(bed, tmp_path, changed):
    own = tmp_path / "own"
    own.write_text("deck")
    peer = code("a", [1.0], own, [])
    before = record_file(tmp_path, bed, peer, 0.01, 1)
    assert record_file(tmp_path, bed, peer, 0.01, 1) == before
    duration = 0.02 if changed == "duration" else 0.01
    if changed == "deck":
        own.write_text("another deck")
    elif changed == "particles":
        bed = replace(bed, particles=bed.particles + 1e-9)
    elif changed == "number":
        bed = replace(bed, parameters=with_numbers(bed.parameters, friction=0.2))
    assert record_file(tmp_path, bed, peer, duration, 1) != before


def test_a_code_that_is_not_there_or_fails_leaves_a_note_and_the_study_goes_on(bed, tmp_path):
    calls, said = [], []
    absent = replace(
        code("absent", [], tmp_path / "x", calls), program="no-such-program", package="absent-dem"
    )
    broken = code("broken", [], tmp_path / "x", calls, fails=True)
    well = code("bedFoam", [2.0], tmp_path / "x", calls, gas=True)
    runs = run_in_turns(bed, [absent, broken, well], tmp_path, 1, 0.01, 75.0, said.append)
    assert calls == ["broken", "bedFoam"]
    assert "apt-get install --no-install-recommends absent-dem" in said[0]
    table = summary(runs, {"box": bed}, [absent, broken, well]).set_index("code")
    assert "not installed" in table.loc["absent", "note"]
    assert table.loc["broken", "note"].startswith("failed: broken has stopped")
    assert table["repeats"].to_dict() == {"absent": 0, "broken": 0, "bedFoam": 1}
    text = markdown(table.reset_index(), ratios(table.reset_index()))
    assert "- absent: absent is not installed" in text and "| bedFoam | 200" in text


def test_medians_and_ratios_by_hand(bed, tmp_path):
    calls, own = [], tmp_path / "x"
    costs = {"bedFoam": [1.2, 9.0, 1.0], "bedFoam, 2 ranks": [0.8] * 3, "DPMFoam": [12.0, 60.0, 11.0]}
    peers = [code(name, walls, own, calls, gas=True, particles=81_000) for name, walls in costs.items()]
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


def test_time_of_other_programs():
    # user, nice, system, idle, waiting, two interrupts, stolen; guests are in user
    text = "cpu  100 10 20 5000 300 1 2 3 40 50\ncpu0 1 2 3\n"
    assert busy_time(text) == pytest.approx(136 / os.sysconf("SC_CLK_TCK"))


def test_a_busy_machine_is_told(bed, tmp_path):
    peers = [code("bedFoam", [1.0], tmp_path / "x", [], gas=True)]
    run = run_in_turns(bed, peers, tmp_path, 1, 0.01, 75.0, lambda line: None)[0]
    quiet = summary([replace(run, others=0.1)], {"box": bed}, peers)
    loud = summary([replace(run, others=0.9)], {"box": bed}, peers)
    assert "other programs" not in markdown(quiet, ratios(quiet))
    assert "other programs were at work during bedFoam" in markdown(loud, ratios(loud))


def test_every_code_names_its_files_and_its_program():
    peers = all_peers(ROOT / "results/bin/bedFoam")
    assert [peer.name for peer in peers] == [
        *("bedFoam", "bedFoam, 2 ranks", "DPMFoam", "LIGGGHTS", "LAMMPS GRANULAR", "Yade"),
    ]
    for peer in peers:
        assert all((ROOT / file).exists() for file in peer.files if file.name != "bedFoam")
    assert "snakemake" in missing(bedfoam.peers(Path("nowhere/bedFoam"))[0])


def test_a_missing_solver_or_case_is_told(tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    with pytest.raises(UserError, match="there is no solver .*build_solver"):
        compare(["short"], tmp_path, tmp_path / "bedFoam", 1, 0.01, 75.0)
    (tmp_path / "bedFoam").touch()
    with pytest.raises(UserError, match="there is no case shorter"):
        compare(["shorter"], tmp_path, tmp_path / "bedFoam", 1, 0.01, 75.0)
    with pytest.raises(UserError, match="--repeats 0: must be above 0"):
        compare(["short"], tmp_path, tmp_path / "bedFoam", 0, 0.01, 75.0)


def test_a_thick_bed_is_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    with pytest.raises(UserError, match="bed.layers: the comparison runs beds of one layer"):
        fluidized_bed(ROOT / "cases/mueller/case.yaml", tmp_path, tmp_path / "bedFoam", 0.1)


def test_packages_of_the_codes_stand_in_one_file():
    listed = [line.split("#")[0].strip() for line in (ROOT / "envs/apt_peers.txt").read_text().splitlines()]
    needed = {peer.package for peer in all_peers(ROOT) if peer.package}
    base = (ROOT / "envs/apt.txt").read_text().split()
    assert needed <= {*listed, *base} and not {*filter(None, listed)} & {*base}


def test_the_table_can_be_drawn(bed, tmp_path):
    peers = [code("bedFoam", [1.0], tmp_path / "x", [], gas=True), code("alone", [0.5], tmp_path / "x", [])]
    runs = run_in_turns(bed, peers, tmp_path, 1, 0.01, 75.0, lambda line: None)
    draw(summary(runs, {"box": bed}, peers), tmp_path / "figures" / "peers")
    assert {file.name for file in (tmp_path / "figures").iterdir()} == {"peers.png", "peers.pdf"}
