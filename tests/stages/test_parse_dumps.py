# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of a run into one trajectory, and the message where one of them is bad."""

import json
import logging

import numpy as np
import pytest

from bedchain.errors import UserError
from made import synthetic_bed
from made.synthetic_bed import rolling_bed, write_run
from parse_dumps import parse_dumps

WIDTH, HEIGHT = 0.08, 0.20
TIMES = np.round(np.arange(0, 1 + 1e-9, 0.025), 6)
# the text form has six significant digits
TEXT_PRECISION = 1e-5


@pytest.fixture
def run(tmp_path):
    """A short run, and how to parse it."""
    frames = rolling_bed(200, WIDTH, 0.1, TIMES)
    dem = write_run(tmp_path, frames, TIMES, WIDTH, HEIGHT)

    def parse():
        parse_dumps(dem, tmp_path / "a.npy", tmp_path / "a.json", WIDTH, HEIGHT, progress=False)

    return dem, frames, parse


def changed(dem, change):
    """Let ``change`` edit the manifest."""
    manifest = json.loads(dem.read_text())
    change(manifest)
    dem.write_text(json.dumps(manifest))


def nothing_left(folder):
    return not [path for path in folder.rglob("*") if "a.npy" in path.name or "a.json" in path.name]


def test_trajectory_is_what_was_simulated(run, tmp_path):
    _, frames, parse = run
    parse()
    trajectory = np.load(tmp_path / "a.npy")
    assert trajectory.dtype == np.float32
    np.testing.assert_array_equal(trajectory, frames.astype(np.float32))
    metadata = json.loads((tmp_path / "a.json").read_text())
    np.testing.assert_allclose(metadata["times_s"], TIMES)
    assert (metadata["ids"], metadata["number"]) == ([1, 200], 200)
    assert (metadata["width_m"], metadata["height_m"]) == (WIDTH, HEIGHT)
    assert metadata["columns"] == ["x", "z", "vx", "vz"]


def test_dumps_without_velocities_are_taken_and_said(run, tmp_path, monkeypatch, caplog):
    _, frames, _ = run
    monkeypatch.setattr(synthetic_bed, "COLUMNS", ["id", "x", "z"])
    dem = write_run(tmp_path / "bare", frames[:, :2], TIMES, WIDTH, HEIGHT)
    with caplog.at_level(logging.INFO, "bedchain"):
        parse_dumps(dem, tmp_path / "b.npy", tmp_path / "b.json", WIDTH, HEIGHT, progress=False)
    trajectory = np.load(tmp_path / "b.npy")
    np.testing.assert_array_equal(trajectory[:, :2], frames[:, :2].astype(np.float32))
    assert np.isnan(trajectory[:, 2:]).all() and "no ['vx', 'vz'] in the dumps" in caplog.text
    monkeypatch.setattr(synthetic_bed, "COLUMNS", ["id", "x", "vx"])
    dem = write_run(tmp_path / "flat", frames[:, :2], TIMES, WIDTH, HEIGHT)
    with pytest.raises(UserError, match="x and z are needed"):
        parse_dumps(dem, tmp_path / "c.npy", tmp_path / "c.json", WIDTH, HEIGHT, progress=False)
    assert not (tmp_path / "c.npy").exists()


def test_text_dumps_give_the_same_trajectory(run, tmp_path):
    _, frames, parse = run
    parse()
    dem = write_run(tmp_path / "text", frames, TIMES, WIDTH, HEIGHT, form="text")
    parse_dumps(dem, tmp_path / "t.npy", tmp_path / "t.json", WIDTH, HEIGHT, progress=False)
    binary, text = np.load(tmp_path / "a.npy"), np.load(tmp_path / "t.npy")
    np.testing.assert_allclose(text, binary, rtol=TEXT_PRECISION)


def test_cut_off_frame_names_frame_file_and_segment(run, tmp_path):
    dem, _, parse = run
    path = dem.parent / json.loads(dem.read_text())["frames"][30]["file"]
    path.write_bytes(path.read_bytes()[:1000])
    with pytest.raises(UserError, match=r"frame 30 of dem/a1b2c3/segment_0002/frame_37500.bin.*cut off"):
        parse()
    assert nothing_left(tmp_path)


def test_frame_that_lost_a_particle_says_which(run, tmp_path):
    dem, _, parse = run
    path = dem.parent / json.loads(dem.read_text())["frames"][5]["file"]
    content = bytearray(path.read_bytes())
    rows = np.frombuffer(content, "<f8", 500, 100 + 4).reshape(100, 5).copy()
    lost = rows[-1, 0]
    content[8:16] = (199).to_bytes(8, "little")
    content[100:104] = (495).to_bytes(4, "little")
    del content[104 + 495 * 8 : 104 + 500 * 8]
    path.write_bytes(content)
    with pytest.raises(UserError, match=rf"frame 5 .*199 particles, 200 expected, missing: id {lost:.0f};"):
        parse()


def test_frame_of_another_step_is_refused(run):
    dem, _, parse = run
    changed(dem, lambda manifest: manifest["frames"][3].update(file=manifest["frames"][4]["file"]))
    with pytest.raises(UserError, match="frame 3 .*its step is 5000, 3750 expected"):
        parse()


def test_missing_frame_file_is_refused(run):
    dem, _, parse = run
    (dem.parent / json.loads(dem.read_text())["frames"][7]["file"]).unlink()
    with pytest.raises(UserError, match="frame 7 .*cannot be read"):
        parse()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda manifest: manifest["frames"].pop(3), "frame 3 .*0.1 s.* follows frame 2 .*0.05 s"),
        (lambda manifest: manifest["frames"].insert(3, manifest["frames"][3]), "frame 4 .* follows frame 3"),
        (lambda manifest: manifest["frames"].reverse(), "frame 1 .* follows frame 0"),
        (lambda manifest: manifest.update(frames=manifest["frames"][:1]), "lists 1 frames"),
        (lambda manifest: manifest.pop("frames"), "no readable manifest"),
    ],
)
def test_frames_missing_doubled_or_out_of_order_are_refused(run, tmp_path, change, message):
    dem, _, parse = run
    changed(dem, change)
    with pytest.raises(UserError, match=message):
        parse()
    assert nothing_left(tmp_path)


def test_earlier_trajectory_survives_a_bad_frame(run, tmp_path):
    dem, _, parse = run
    parse()
    before = (tmp_path / "a.npy").read_bytes()
    path = dem.parent / json.loads(dem.read_text())["frames"][-1]["file"]
    path.write_bytes(b"")
    with pytest.raises(UserError, match="frame 40"):
        parse()
    assert (tmp_path / "a.npy").read_bytes() == before
