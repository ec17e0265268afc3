# SPDX-License-Identifier: GPL-3.0-or-later
"""Segments: their stamp, the frames that each owns, and the manifest of the whole run."""

import pytest

from bedchain.dem import segments
from bedchain.dem.segments import Segment, SegmentedRun
from bedchain.errors import UserError

PARAMETERS = """# made
variable dem_step equal 2e-05  # [s] time.dem_step_s
variable frame_steps equal 100  # [-] derived
variable number equal 7  # [-]
variable depth_walls equal 0  # [-]
variable dump_suffix string bin  # [-]
"""


@pytest.fixture
def run(tmp_path):
    """A run of two segments, at frames 0 to 4 and 4 to 6, with all its frames there."""
    (tmp_path / "parameters.lig").write_text(PARAMETERS)
    run = SegmentedRun(tmp_path, tmp_path, "a1b2", 2, 0, 600, "settled")
    for index, (start, end) in enumerate(((0, 400), (400, 600)), start=1):
        folder = run.state / f"segment_{index:04d}"
        folder.mkdir(parents=True)
        for step in range(start, end + 1, 100):
            (folder / f"frame_{step}.bin").write_bytes(b"x" * (step + 1))
        segments.write_record(folder, Segment(index, start, end, folder.name, 4.0, 3.0, 0.5, 0.25))
    return run


def test_a_stamp_changes_with_every_input(tmp_path):
    files = [tmp_path / "deck", tmp_path / "numbers"]
    for file in files:
        file.write_text(file.name)
    stamps = [
        segments.input_stamp(files, 2),
        segments.input_stamp(files, 1),
        segments.input_stamp(files[::-1], 2),
        segments.input_stamp(files, 2, "kick"),
    ]
    files[0].write_text("another")
    stamps.append(segments.input_stamp(files, 2))
    assert len(set(stamps)) == 5
    files[0].write_text("deck")
    assert segments.input_stamp(files, 2) == stamps[0]


def test_parameters_are_numbers_and_words(run, tmp_path):
    parameters = segments.read_parameters(tmp_path / "parameters.lig")
    assert parameters["dem_step"] == 2e-5 and parameters["dump_suffix"] == "bin"
    assert segments.frame_columns(parameters) == ["id", "x", "z", "vx", "vz"]
    assert "y" in segments.frame_columns({"depth_walls": 1.0})
    with pytest.raises(UserError, match="none is missing: run scripts/write_parameters.py first"):
        segments.read_parameters(tmp_path / "none")


def test_finished_segments_end_at_the_first_gap(run):
    assert [item.end_step for item in segments.finished_segments(run.state)] == [400, 600]
    (run.state / "segment_0001" / segments.RECORD).unlink()
    assert segments.finished_segments(run.state) == []


def test_a_segment_keeps_the_frames_after_its_start_and_the_first_of_all(run):
    for index, steps in ((1, (0, 400)), (2, (400, 600))):
        segments.keep_own_frames(run.state / f"segment_{index:04d}", run, steps, 100, "bin")
    names = [sorted(file.name for file in folder.glob("frame_*")) for folder in sorted(run.state.iterdir())]
    assert names == [
        [f"frame_{step}.bin" for step in steps] for steps in ((0, 100, 200, 300, 400), (500, 600))
    ]


@pytest.mark.parametrize("fault", ["missing", "empty"])
def test_a_frame_that_is_not_there_is_named(run, fault):
    frame = run.state / "segment_0001" / "frame_200.bin"
    frame.unlink() if fault == "missing" else frame.write_bytes(b"")
    with pytest.raises(UserError, match="frame_200.bin was not written: see the solver's log"):
        segments.keep_own_frames(frame.parent, run, (0, 400), 100, "bin")


def test_the_manifest_lists_each_frame_once_with_its_owner(run):
    manifest = segments.manifest(run, segments.finished_segments(run.state))
    assert [frame["step"] for frame in manifest["frames"]] == [0, 100, 200, 300, 400, 500, 600]
    owners = [frame["file"].split("/")[-2] for frame in manifest["frames"]]
    assert owners == ["segment_0001"] * 5 + ["segment_0002"] * 2
    assert [frame["bytes"] for frame in manifest["frames"]] == [1, 101, 201, 301, 401, 501, 601]
    assert manifest["frame_interval_s"] == pytest.approx(2e-3) and manifest["number"] == 7
    assert manifest["segments"][1] == {
        "index": 2, "start_s": pytest.approx(8e-3), "end_s": pytest.approx(0.012),
        "folder": "dem/a1b2/segment_0002", "wall_s": 4.0, "dem_s": 3.0, "exchange_s": 0.5, "gas_s": 0.25,
    }  # fmt: skip
