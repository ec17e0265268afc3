# SPDX-License-Identifier: GPL-3.0-or-later
"""Segments: their stamp, the frames that each owns, their records, and the manifest of the whole run."""

import json

import pytest

from bedchain.dem import segments
from bedchain.dem.segments import Segment, SegmentedRun, finished
from bedchain.errors import DataError, UserError
from bedchain.fingerprints import fingerprint_of
from bedchain.trajectory.store import RECORD
from made.solver_files import write_dump, write_gas, write_restart

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
    follows = ""
    for index, (start, end) in enumerate(((0, 400), (400, 600)), start=1):
        folder = run.state / f"segment_{index:04d}"
        folder.mkdir(parents=True)
        for step in range(start, end + 1, 100):
            write_dump(folder / f"frame_{step}.bin", step, 7)
        write_restart(folder / segments.RESTART, 7, word=b"%d" % index)
        write_gas(folder / "gas", end * 2e-5)
        (folder / "bedFoam.log").write_text("log")
        segment = Segment(index, start, end, folder.name, 4.0, 3.0, 0.5, 0.25, follows, cpu_s=3.75)
        follows = segments.write_record(folder, segment).state
    return run


def both(run):
    return [finished(run.state / f"segment_{index:04d}") for index in (1, 2)]


def test_a_stamp_changes_with_every_input(tmp_path):
    files = [tmp_path / "deck", tmp_path / "numbers"]
    for file in files:
        file.write_text(file.name)
    stamps = [
        segments.input_stamp(files),
        segments.input_stamp(files[::-1]),
        segments.input_stamp(files, "kick"),
    ]
    files[0].write_text("another")
    stamps.append(segments.input_stamp(files))
    assert len(set(stamps)) == 4
    files[0].write_text("deck")
    assert segments.input_stamp(files) == stamps[0]


def test_parameters_are_numbers_and_words(run, tmp_path):
    parameters = segments.read_parameters(tmp_path / "parameters.lig")
    assert parameters["dem_step"] == 2e-5 and parameters["dump_suffix"] == "bin"
    assert segments.frame_columns(parameters) == ["id", "x", "z", "vx", "vz"]
    assert "y" in segments.frame_columns({"depth_walls": 1.0})
    with pytest.raises(UserError, match="none is missing: run scripts/write_parameters.py first"):
        segments.read_parameters(tmp_path / "none")


def test_a_record_knows_each_file_but_the_logs(run):
    first, second = both(run)
    assert (first.end_step, second.end_step) == (400, 600)
    assert {"frame_0.bin", "particles.restart", "gas/0.008/U"} <= first.files.keys()
    assert not {"bedFoam.log", RECORD} & first.files.keys()
    assert first.files["frame_0.bin"] == fingerprint_of(run.state / "segment_0001" / "frame_0.bin")
    assert finished(run.state / "segment_0002", 400, first.state) == second
    assert finished(run.state / "segment_0003") is None


@pytest.mark.parametrize("name", ["particles.restart", "gas/0.012/U", "frame_500.bin", RECORD])
@pytest.mark.parametrize("damage", ["cut", "missing", "longer", "empty"])
def test_a_damaged_file_is_named(run, name, damage):
    file = run.state / "segment_0002" / name
    content = file.read_bytes()
    file.unlink()
    if damage != "missing":
        file.write_bytes(
            {"cut": content[: len(content) // 2], "longer": content + b"x", "empty": b""}[damage]
        )
    with pytest.raises(DataError, match=file.name):
        finished(run.state / "segment_0002")


def test_changed_bytes_are_seen_at_once_in_a_state_and_in_a_frame_when_it_is_read(run):
    for name in ("frame_500.bin", "particles.restart"):
        file = run.state / "segment_0002" / name
        file.write_bytes(b"x" + file.read_bytes()[1:])
        if name == "frame_500.bin":
            assert finished(run.state / "segment_0002").end_step == 600
    with pytest.raises(DataError, match="particles.restart was changed"):
        finished(run.state / "segment_0002")


def test_a_segment_must_go_on_from_the_state_before_it(run):
    with pytest.raises(DataError, match="segment_0002 did not go on from the state before it"):
        finished(run.state / "segment_0002", 400, "another")
    with pytest.raises(DataError, match="segment_0002 begins at step 400"):
        finished(run.state / "segment_0002", 500)


@pytest.mark.parametrize(
    ("key", "value"), [("folder", "segment_0001"), ("end_step", "600"), ("files", {"U": {}}), ("x", 1)]
)
def test_a_record_that_is_none_is_refused(run, key, value):
    record = run.state / "segment_0002" / RECORD
    record.write_text(json.dumps(json.loads(record.read_text()) | {key: value}))
    with pytest.raises(DataError, match=RECORD):
        finished(record.parent)


def test_a_record_of_an_earlier_version_has_no_fingerprints_and_gets_them(run):
    record = run.state / "segment_0001" / RECORD
    old = json.loads(record.read_text())
    expected = old["files"]
    del old["files"], old["follows"]
    record.write_text(json.dumps(old))
    assert finished(record.parent).files == expected


def test_a_segment_keeps_the_frames_after_its_start_and_the_first_of_all(run):
    parameters = segments.read_parameters(run.case / "parameters.lig")
    for index, steps in ((1, (0, 400)), (2, (400, 600))):
        segments.keep_own_frames(run.state / f"segment_{index:04d}", run, steps, parameters)
    names = [sorted(file.name for file in folder.glob("frame_*")) for folder in sorted(run.state.iterdir())]
    assert names == [
        [f"frame_{step}.bin" for step in steps] for steps in ((0, 100, 200, 300, 400), (500, 600))
    ]


@pytest.mark.parametrize("fault", ["missing", "empty", "cut", "of another step"])
def test_a_frame_that_is_not_complete_is_named(run, fault):
    frame = run.state / "segment_0001" / "frame_200.bin"
    content = frame.read_bytes()
    frame.unlink()
    if fault == "of another step":
        write_dump(frame, 300, 7)
    elif fault != "missing":
        frame.write_bytes(content[: {"empty": 0, "cut": -8}[fault]])
    with pytest.raises(UserError, match=r"frame_200.bin"):
        parameters = segments.read_parameters(run.case / "parameters.lig")
        segments.keep_own_frames(frame.parent, run, (0, 400), parameters)


def test_the_manifest_lists_each_frame_once_with_its_owner_and_its_fingerprint(run):
    manifest = segments.manifest(run, both(run))
    assert [frame["step"] for frame in manifest["frames"]] == [0, 100, 200, 300, 400, 500, 600]
    owners = [frame["file"].split("/")[-2] for frame in manifest["frames"]]
    assert owners == ["segment_0001"] * 5 + ["segment_0002"] * 2
    for frame in manifest["frames"]:
        assert fingerprint_of(run.results / frame["file"]) == {
            key: frame[key] for key in ("bytes", "blake2b")
        }
    assert manifest["frame_interval_s"] == pytest.approx(2e-3) and manifest["number"] == 7
    assert manifest["segments"][1] == {
        "index": 2, "start_s": pytest.approx(8e-3), "end_s": pytest.approx(0.012),
        "folder": "dem/a1b2/segment_0002", "wall_s": 4.0, "dem_s": 3.0, "exchange_s": 0.5, "gas_s": 0.25,
        "cpu_s": 3.75,
    }  # fmt: skip
