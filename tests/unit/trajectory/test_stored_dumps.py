# SPDX-License-Identifier: GPL-3.0-or-later
"""Dumps of a run in the trajectory, and every fault of a frame named; nothing is left of a broken run."""

import json

import numpy as np
import pytest

from bedchain.errors import UserError
from bedchain.fingerprints import fingerprint_of
from bedchain.trajectory.store import RECORD, open_trajectory
from bedchain.trajectory.stored_dumps import write_trajectory
from made.synthetic_bed import rolling_bed, write_run

TIMES = np.round(np.arange(0, 0.2 + 1e-9, 0.025), 6)


@pytest.fixture
def bed(tmp_path):
    """Frames of 20 particles, and the manifest of the run that they are written as."""
    frames = rolling_bed(20, 0.08, 0.2, TIMES)
    return frames, write_run(tmp_path, frames, TIMES, 0.08, 0.2, segment=0.1)


def parse(dem):
    files = dem.parent / "trajectory.npy", dem.parent / "trajectory.json"
    write_trajectory(dem, *files, 0.08, 0.2, progress=False)
    return open_trajectory(*files)


def changed(dem, change):
    """The manifest with a change made to it."""
    manifest = json.loads(dem.read_text())
    change(manifest)
    dem.write_text(json.dumps(manifest))


def test_frames_come_back_in_single_precision_and_by_id(bed):
    frames, dem = bed
    store, about = parse(dem)
    assert (store == frames.astype(np.float32)).all()
    assert about["times_s"] == pytest.approx(TIMES) and (about["ids"], about["number"]) == ([1, 20], 20)


def test_columns_that_the_dumps_lack_are_nothing_or_refused(bed):
    _, dem = bed
    changed(dem, lambda manifest: manifest.update(columns=["id", "x", "z", "fx", "fz"]))
    store, _ = parse(dem)
    assert np.isfinite(store[:, :2]).all() and np.isnan(store[:, 2:]).all()
    changed(dem, lambda manifest: manifest.update(columns=["id", "x", "y", "vx", "vz"]))
    with pytest.raises(UserError, match="the dumps hold id x y vx vz, x and z are needed"):
        parse(dem)


def test_a_frame_of_another_step_or_with_a_particle_less_leaves_nothing(bed, tmp_path):
    _, dem = bed
    changed(dem, lambda manifest: manifest["frames"][5].update(step=7000))
    with pytest.raises(UserError, match="frame 5 of .*its step is 6250, 7000 expected; put whole frames"):
        parse(dem)
    changed(dem, lambda manifest: manifest.update(number=21))
    with pytest.raises(UserError, match="frame 0 of .*it holds 20 particles, 21 expected"):
        parse(dem)
    assert not list(tmp_path.glob("trajectory*"))


def test_a_frame_with_other_bytes_has_its_segment_made_again(bed):
    _, dem = bed
    frame = dem.parent / json.loads(dem.read_text())["frames"][5]["file"]
    changed(dem, lambda manifest: manifest["frames"][5].update(fingerprint_of(frame)))
    (frame.parent / RECORD).write_text("{}")
    content = bytearray(frame.read_bytes())
    content[-1] ^= 1  # one bit of a velocity
    frame.write_bytes(content)
    with pytest.raises(UserError, match="frame 5 of .*changed.*same command again: it makes segment_0002"):
        parse(dem)
    assert not dem.exists() and [file.name for file in frame.parent.glob("*.json*")] == [f"{RECORD}.damaged"]
