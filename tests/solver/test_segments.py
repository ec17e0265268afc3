# SPDX-License-Identifier: GPL-3.0-or-later
"""A run in segments: killed anywhere, it goes on and leaves the same frames as one that was left alone."""

import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pandas as pd
import pytest

from bedchain.dem.run import run_dem
from bedchain.errors import UserError
from bedchain.trajectory.dumps import read_dump

FRAMES = 16  # 0 to 0.06 s each 0.004 s
DEADLINE_S = 120.0
BORDER_S, GAS_STEP_S = 0.05, 1e-4
BORDER = 1e-12  # [m] and [m/s], after the first gas step behind a border
MOVED = 1e-4  # [m/s], by which some particle's velocity changes in that step


def frames_of(folder):
    """Contents of all frames by time, as dem.json lists them."""
    listed = json.loads((folder / "dem.json").read_text())
    return {frame["time_s"]: (folder / frame["file"]).read_bytes() for frame in listed["frames"]}


def state(folder, back):
    """x, z [m], vx, vz [m/s] of all particles in order, in the last frame (1) or an earlier one."""
    frame = json.loads((folder / "dem.json").read_text())["frames"][-back]["file"]
    values = read_dump(folder / frame, ["id", "x", "z", "vx", "vz"]).values
    return values[np.argsort(values[:, 0]), 1:]


def start(folder, ranks):
    command = [sys.executable, "scripts/run_dem.py", str(folder), "--end", "0.06", "--segment", "0.02"]
    return subprocess.Popen([*command, "--ranks", str(ranks)], stderr=subprocess.DEVNULL)


def wait_for(find):
    """First thing that `find` yields, waiting for it."""
    deadline = time.monotonic() + DEADLINE_S
    while time.monotonic() < deadline:
        for found in find():
            return found
        time.sleep(0.005)
    raise AssertionError("nothing found before the deadline")


@pytest.mark.parametrize("ranks", [1, 2])
def test_a_killed_run_goes_on_with_no_frame_lost_doubled_or_torn(make_bed, ranks):
    whole, killed = make_bed("whole"), make_bed("killed")
    run_dem(whole, 0.06, 0.02, ranks)

    process = start(killed, ranks)
    # In the middle of the second segment: its first frame is there, the segment is not finished
    wait_for(lambda: killed.glob("dem/*/segment_0002.part/frame_*"))
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    assert not list(killed.glob("dem/*/segment_0002"))
    assert not (killed / "dem.json").exists()

    second = start(killed, ranks)
    assert second.wait() == 0
    expected, found = frames_of(whole), frames_of(killed)
    assert list(found) == list(expected)
    assert len(found) == FRAMES
    assert found == expected
    pd.testing.assert_frame_equal(
        pd.read_csv(killed / "bed_series.csv"), pd.read_csv(whole / "bed_series.csv")
    )


def test_a_finished_run_is_left_alone_and_a_longer_one_goes_on(make_bed):
    folder = make_bed("bed")
    run_dem(folder, 0.04, 0.02, 1)
    first = {file: file.stat().st_mtime_ns for file in folder.glob("dem/*/segment_*/frame_*")}
    run_dem(folder, 0.06, 0.02, 1)
    assert all(file.stat().st_mtime_ns == then for file, then in first.items())
    assert len(frames_of(folder)) == FRAMES


@pytest.mark.parametrize("ranks", [1, 2])
def test_a_border_between_segments_leaves_no_trace(make_bed, ranks):
    time = {"gas_step_s": GAS_STEP_S, "frame_interval_s": GAS_STEP_S}
    one, two = (make_bed(name, time=time) for name in ("one", "two"))
    run_dem(one, BORDER_S + GAS_STEP_S, BORDER_S + GAS_STEP_S, ranks)
    run_dem(two, BORDER_S + GAS_STEP_S, BORDER_S, ranks)
    # The neighbour list is made anew at the border, which sums the contacts in another order
    at_border, after = ([state(folder, back) for folder in (one, two)] for back in (2, 1))
    np.testing.assert_array_equal(at_border[1], at_border[0])
    assert np.abs(after[0] - at_border[0])[:, 2:].max() > MOVED
    np.testing.assert_allclose(after[1], after[0], rtol=0, atol=BORDER)


def test_other_inputs_get_a_folder_of_their_own(make_bed):
    folder = make_bed("bed")
    run_dem(folder, 0.02, 0.02, 1)
    before = frames_of(folder)
    make_bed("bed", gas={"drag_law": "beetstra"})
    run_dem(folder, 0.02, 0.02, 1)
    assert len(list(folder.glob("dem/*/segment_0001"))) == 2
    assert frames_of(folder) != before


@pytest.mark.parametrize("name", ["settled/particles.restart", "segment_0001/particles.restart"])
def test_a_restart_cut_off_is_made_again_with_all_that_follows_the_same(make_bed, name, capfd):
    folder = make_bed("bed")
    run_dem(folder, 0.06, 0.02, 1)
    expected = frames_of(folder)
    [restart] = folder.glob(f"dem/*/{name}")
    whole = restart.read_bytes()
    restart.write_bytes(whole[: len(whole) // 2])
    kept = {file: file.stat().st_mtime_ns for file in folder.glob("dem/*/segment_000[23]/frame_*")}
    run_dem(folder, 0.06, 0.02, 1)
    assert f"{name.split('/')[0]} is made again, it is " in capfd.readouterr().out
    assert restart.read_bytes() == whole and frames_of(folder) == expected
    assert all(file.stat().st_mtime_ns == then for file, then in kept.items())


def test_one_run_at_a_time(make_bed):
    folder = make_bed("bed")
    process = start(folder, 1)
    try:
        wait_for(lambda: folder.glob("dem/*/settled.part"))
        with pytest.raises(UserError, match=f"in use by process {process.pid}"):
            run_dem(folder, 0.06, 0.02, 1)
    finally:
        process.terminate()
        process.wait()


def test_a_solver_that_stops_says_why_and_where_to_go_on(make_bed):
    # The top of the box within the bed: the first particles that rise are lost
    folder = make_bed("bed")
    text = (folder / "parameters.lig").read_text()
    (folder / "parameters.lig").write_text(text.replace("variable skin equal", "variable skin string no  #"))
    with pytest.raises(UserError, match="(?s)liggghts ended with code.*ERROR.*whole log"):
        run_dem(folder, 0.02, 0.02, 1)
    assert not list(folder.glob("dem/*/settled"))
