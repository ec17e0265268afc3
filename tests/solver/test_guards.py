# SPDX-License-Identifier: GPL-3.0-or-later
"""What goes wrong stops the run, on all ranks, with the place, the time and the last good restart."""

import re
import shutil
import subprocess
import sys

import pandas as pd
import pytest

from bedchain.dem import gas_case
from bedchain.dem import run as stage
from bedchain.dem.lattices import lattice
from bedchain.dem.segments import SETTLED, SegmentedRun, input_stamp
from bedchain.dem.small_cases import Setup, run_gas
from bedchain.errors import UserError

DEADLINE_S = 600  # a run that hangs; one that stops takes a second or two on an idle machine
VECTOR = r"\((?P<x>\S+) \S+ (?P<z>\S+)\)"
WIDTH, HEIGHT, DIAMETER = 0.02, 0.06, 1e-3
END_S, SEGMENT_S, STEP_S = 0.06, 0.02, 2e-5
LEAST_VOIDAGE = 0.2
LARGEST = 0.5  # the default of contact.largest_overlap_1
STOP = r"at (?P<time>\S+) s\. The last finished segment is intact"
OVERLAP = rf"particle \d+ at {VECTOR} m and (particle \d+|the wall \w+) overlap by (?P<depth>\S+) .*?{STOP}"
LOST = rf"particle \d+ has left the bed \(\d+ lost\), last seen at {VECTOR} m, {STOP}"
VOIDAGE = rf"voidage (?P<voidage>\S+) in the gas cell at {VECTOR} m, .*?{STOP}"
PRESSURE = rf"the pressure is not solved after 2 .*largest residual \S+ in the gas cell at {VECTOR} m, {STOP}"
DIVERGED = rf"(not solved|has diverged).* in the gas cell at {VECTOR} m, {STOP}"


@pytest.fixture(scope="module")
def settled_once(tmp_path_factory):
    """Folder that keeps the settled tiny bed for all faults."""
    return tmp_path_factory.mktemp("settled")


@pytest.fixture
def faulty_bed(make_bed, settled_once):
    """Function that makes a tiny bed, settled by the healthy case, with a fault in its case or parameters."""

    def make(ranks, edits=(), deck_edits=(), **changes):
        if not (settled_once / "particles.restart").exists():
            run = run_of(make_bed("healthy"), 1)
            stage.settle(run)
            shutil.copytree(run.state / SETTLED, settled_once, dirs_exist_ok=True)
        folder = make_bed("faulty", **changes)
        wanted = [("caseParameters", f"{name} ", f"{value};") for name, value in edits]
        wanted += [("parameters.lig", f"variable {name} equal ", value) for name, value in deck_edits]
        for file, entry, value in wanted:
            text, found = re.subn(rf"^{entry}\S+", f"{entry}{value}", (folder / file).read_text(), flags=re.M)
            assert found == 1
            (folder / file).write_text(text)
        shutil.copytree(settled_once, run_of(folder, ranks).state / SETTLED)
        return folder

    return make


def run_of(folder, ranks):
    """The run that the command line makes of a folder."""
    stamp = input_stamp(stage.input_files(folder))
    return SegmentedRun(folder, folder, stamp, ranks, 0, round(END_S / STEP_S), SETTLED)


def stopped(folder, ranks, pattern):
    """What the command line says of a run that stops, with an exit code and without a traceback."""
    command = [
        sys.executable,
        "scripts/run_dem.py",
        str(folder),
        "--end",
        str(END_S),
        "--segment",
        str(SEGMENT_S),
    ]
    done = subprocess.run(
        [*command, "--ranks", str(ranks)], capture_output=True, text=True, check=False, timeout=DEADLINE_S
    )
    assert done.returncode != 0, done.stdout
    assert "Traceback" not in done.stderr
    assert re.search(r"last good state: \S+/particles\.restart", done.stderr), done.stderr
    assert not (folder / "dem.json").exists()
    return told(done.stderr, pattern)


def told(message, pattern):
    """The match of a message that has said once what is wrong, where in the box and when."""
    message = " ".join(message.split())
    found = re.search(pattern, message)
    assert found, message
    assert message.count("The last finished segment") == 1
    assert -DIAMETER < float(found["x"]) < WIDTH + DIAMETER
    assert -DIAMETER < float(found["z"]) < HEIGHT + DIAMETER
    assert 0 <= float(found["time"]) <= END_S
    return found


@pytest.mark.parametrize(
    ("ranks", "changes"),
    [
        (1, {"time": {"dem_step_s": 2.5e-4, "allow_unstable_step": True}}),
        (2, {"time": {"dem_step_s": 2.5e-4, "allow_unstable_step": True}}),
        (1, {"deck_edits": [("young", "10.0")], "gas": {"voidage_clip": "count"}}),
    ],
    ids=["step_too_long", "step_too_long_on_two_ranks", "too_soft"],
)
def test_particles_too_deep_in_each_other_stop_the_run(faulty_bed, ranks, changes):
    found = stopped(faulty_bed(ranks, **changes), ranks, OVERLAP)
    assert LARGEST < float(found["depth"]) < 1


def test_a_voidage_that_no_bed_can_have_stops_the_run(faulty_bed):
    # A slab half as thick as its particles: over-packed
    folder = faulty_bed(2, [("slab_low", "-0.00025"), ("slab_high", "0.00025")])
    found = stopped(folder, 2, VOIDAGE + r".*gas\.voidage_clip: count")
    assert float(found["voidage"]) < LEAST_VOIDAGE
    assert float(found["time"]) == 0


def overpacked(folder, clip):
    """Particles of a lattice pressed into each other by 20 %, held in place: voidage 0.18."""
    sections = {
        "bed": {"width_m": WIDTH, "height_m": HEIGHT},
        "particles": {"number": 1},  # more do not fit side by side: the deck gets the true number below
        "gas": {"voidage_clip": clip},
        "time": {"frame_interval_s": 0.01},
    }
    spheres = lattice(WIDTH, HEIGHT, 0.8 * DIAMETER, DIAMETER)
    return Setup(folder, sections, spheres, {"frozen": 1, "number": len(spheres)})


def test_a_voidage_clip_that_the_case_allows_is_counted(solver, tmp_path, monkeypatch):
    monkeypatch.chdir(stage.Path(__file__).parents[2])
    with pytest.raises(UserError, match=VOIDAGE):
        run_gas(overpacked(tmp_path / "stops", "stop"), solver, 0.005, "constant 0.1")
    table = run_gas(overpacked(tmp_path / "counts", "count"), solver, 0.005, "constant 0.1")
    cells = 4 * 12
    assert (table["voidage_clips_1"] == cells).all()
    assert table["smallest_voidage_1"].to_numpy() == pytest.approx(LEAST_VOIDAGE)
    assert table["largest_overlap_1"].to_numpy() == pytest.approx(0.2)


@pytest.mark.parametrize("ranks", [1, 2])
def test_a_pressure_that_is_not_solved_stops_the_run(faulty_bed, tmp_path, monkeypatch, ranks):
    case = tmp_path / "openfoam_case"
    shutil.copytree(stage.GAS_CASE, case)
    with (case / "system" / "fvSolution").open("a") as stream:
        few = "maxIter 2; relTol 0; tolerance 1e-14;"
        stream.write(f"solvers {{ p {{ {few} }} pBand {{ preconditioner DIC; {few} }} }}\n")
    monkeypatch.setattr(gas_case, "GAS_CASE", case)
    monkeypatch.setattr(stage, "GAS_CASE", case)
    folder = faulty_bed(ranks)
    with pytest.raises(UserError) as error:
        stage.run_dem(folder, SEGMENT_S, SEGMENT_S, ranks)
    told(str(error.value), PRESSURE)
    assert "last good state: " in str(error.value)


def test_gas_that_diverges_stops_the_run(faulty_bed):
    stopped(faulty_bed(1, [("superficial_velocity", "1e180")]), 1, DIVERGED)


def test_a_lost_particle_stops_the_run_and_leaves_the_segments_before(faulty_bed):
    # Gas faster than the particles fall blows them out of the box after the first segment
    folder = faulty_bed(1, gas={"superficial_velocity_m_s": 10.0}, time={"gas_step_s": 2e-4})
    found = stopped(folder, 1, LOST)
    assert float(found["time"]) > SEGMENT_S
    kept = {file: file.stat().st_mtime_ns for file in folder.glob("dem/*/segment_0001/**/*")}
    assert kept
    # Again from the last good restart, to the same end
    assert stopped(folder, 1, LOST)["time"] == found["time"]
    assert kept == {file: file.stat().st_mtime_ns for file in folder.glob("dem/*/segment_0001/**/*")}


def test_a_lost_particle_stops_both_ranks(faulty_bed):
    # a stronger blast ends the gas first, on some machines
    stopped(faulty_bed(2, [("superficial_velocity", "20"), ("ramp_time", "0.002")]), 2, LOST)


def test_the_series_reports_the_deepest_overlap(faulty_bed):
    folder = faulty_bed(1)
    stage.run_dem(folder, SEGMENT_S, SEGMENT_S, 1)
    overlap = pd.read_csv(folder / "bed_series.csv")["largest_overlap_1"]
    # The weight of fifteen layers alone presses the lowest by a share of a percent
    assert overlap.between(1e-3, 0.05).all(), overlap.to_string()
