# SPDX-License-Identifier: GPL-3.0-or-later
"""A run in segments with solvers that write what the real ones would; those are in tests/solver."""

import json
import shutil

import pandas as pd
import pytest

from bedchain.dem import run as dem_run
from bedchain.dem.parameter_files import write_parameters
from bedchain.errors import UserError
from bedchain.fingerprints import fingerprint_of, note_of
from bedchain.work_folders import work_folder
from made.case_text import changed_case
from made.solver_files import write_dump, write_restart


def test_a_run_settles_then_goes_on_segment_by_segment_and_does_nothing_twice(folder, starts):
    times, _ = starts
    dem_run.run_dem(folder, 1.0, 0.5, 1)
    assert times == ["in.settle", 0.0, 0.5]
    manifest = json.loads((folder / "dem.json").read_text())
    assert len(manifest["frames"]) == 41 and [segment["end_s"] for segment in manifest["segments"]] == [
        0.5,
        1.0,
    ]
    series = pd.read_csv(folder / "bed_series.csv")["time_s"]
    assert series.iloc[-1] == 1.0 and series.is_monotonic_increasing
    for name in ("bed_series.csv", "dem.json"):
        assert json.loads(note_of(folder / name).read_text()) == fingerprint_of(folder / name)
    dem_run.run_dem(folder, 1.0, 0.5, 1)
    assert len(times) == 3
    # a longer run goes on, a shorter one leaves out what is beyond
    dem_run.run_dem(folder, 1.5, 0.5, 1)
    assert times[3:] == [1.0]
    dem_run.run_dem(folder, 0.5, 0.5, 1)
    assert len(json.loads((folder / "dem.json").read_text())["segments"]) == 1


def test_a_segment_that_fails_leaves_those_before_and_says_where_to_go_on(folder, starts):
    times, broken = starts
    broken.add(0.5)
    with pytest.raises(UserError, match="code 1\nlast good state: .*segment_0001/particles.restart"):
        dem_run.run_dem(folder, 1.0, 0.5, 1)
    assert not (folder / "dem.json").exists()
    broken.clear()
    dem_run.run_dem(folder, 1.0, 0.5, 1)
    assert times == ["in.settle", 0.0, 0.5, 0.5]


def test_another_number_begins_anew(folder, starts, tmp_path):
    times, _ = starts
    dem_run.run_dem(folder, 0.5, 0.5, 1)
    write_parameters(changed_case(tmp_path, ("number: 7200", "number: 7000")), folder)
    dem_run.run_dem(folder, 0.5, 0.5, 1)
    assert times == ["in.settle", 0.0] * 2


@pytest.mark.parametrize(("end", "segment", "message"), [(0.51, 0.5, "--end"), (1.0, 0.0, "--segment")])
def test_times_must_be_whole_frames(folder, end, segment, message):
    with pytest.raises(UserError, match=f"{message} must be a whole number of frame intervals, 0.025 s each"):
        dem_run.run_dem(folder, end, segment, 1)


def test_a_repeat_starts_where_a_segment_ends_and_ends_later(folder, starts):
    dem_run.run_dem(folder, 1.0, 0.5, 1)
    with pytest.raises(UserError, match="no segment of the run ends at 0.75 s"):
        dem_run.repeat_dem(folder, 0.75, 1.0, 0.5, 1, 1)
    with pytest.raises(UserError, match="--end, 0.5 s, must be after --start, 1 s"):
        dem_run.repeat_dem(folder, 1.0, 0.5, 0.5, 1, 1)


def test_a_missing_solver_is_named(folder, tmp_path):
    (tmp_path / "bedFoam").unlink()
    with pytest.raises(UserError, match="bedFoam missing: run snakemake"):
        dem_run.input_files(folder)


def frames(folder):
    listed = json.loads((folder / "dem.json").read_text())["frames"]
    return {frame["step"]: (folder / frame["file"]).read_bytes() for frame in listed}


@pytest.mark.parametrize(
    ("name", "again"),
    [
        ("segment_0001/particles.restart", [0.0]),
        ("segment_0002/frame_31250.bin", [0.5]),
        ("segment_0003/segment.json", [1.0]),
        ("settled/particles.restart", ["in.settle"]),
    ],
)
def test_a_damaged_segment_is_named_and_made_again_alone(folder, starts, name, again, capsys):
    times, _ = starts
    dem_run.run_dem(folder, 1.5, 0.5, 1)
    before = frames(folder)
    [file] = folder.glob(f"dem/*/{name}")
    file.write_bytes(file.read_bytes()[:-9])
    times.clear()
    (folder / "dem.json").unlink()
    dem_run.run_dem(folder, 1.5, 0.5, 1)
    assert times == again  # the ones after it follow from the same bytes
    assert frames(folder) == before
    assert f"run_dem: {name.split('/')[0]} is made again, it is " in capsys.readouterr().out


def test_segments_after_one_that_came_out_otherwise_are_made_again_too(folder, starts):
    times, _ = starts
    dem_run.run_dem(folder, 1.5, 0.5, 1)
    [state] = folder.glob("dem/*/settled")
    shutil.rmtree(state)
    state.mkdir()
    write_restart(state / "particles.restart", 7200, word=b"another.")
    dem_run.write_record(state, dem_run.Segment(0, 0, 0, "settled", 0, 0, 0, 0))
    times.clear()
    dem_run.run_dem(folder, 1.5, 0.5, 1)
    assert times == [0.0, 0.5, 1.0]


def test_a_folder_that_is_left_over_is_made_again_once(folder, starts):
    times, _ = starts
    dem_run.run_dem(folder, 0.5, 0.5, 1)
    [first] = folder.glob("dem/*/segment_0001")
    shutil.copytree(first, first.with_name("segment_0002"))
    (first / "segment.json").unlink()
    times.clear()
    dem_run.run_dem(folder, 1.0, 0.5, 1)
    dem_run.run_dem(folder, 1.0, 0.5, 1)
    assert times == [0.0, 0.5]


def test_what_a_kill_lost_is_said(folder, starts, capsys):
    dem_run.run_dem(folder, 0.5, 0.5, 1)
    [first] = folder.glob("dem/*/segment_0001")
    part = first.with_name("segment_0002.part")
    work_folder(part)
    write_dump(part / "frame_26250.bin", 26250, 7200)
    dem_run.run_dem(folder, 1.0, 0.5, 1)
    assert "within segment_0002, of which 1 frames are lost; it is made again" in capsys.readouterr().out
