# SPDX-License-Identifier: GPL-3.0-or-later
"""The trajectory of a run, and every fault of its manifest named; runs are in tests/stages."""

import json
import os

import numpy as np
import pytest

from bedchain.errors import UserError
from bedchain.trajectory.store import open_trajectory, read_manifest
from bedchain.trajectory.stored_dumps import write_trajectory
from made.synthetic_bed import rolling_bed, write_run

TIMES = np.round(np.arange(0, 0.2 + 1e-9, 0.025), 6)


@pytest.fixture
def bed(tmp_path):
    """Frames of 20 particles, and the manifest of the run that they are written as."""
    frames = rolling_bed(20, 0.08, 0.2, TIMES)
    return frames, write_run(tmp_path, frames, TIMES, 0.08, 0.2, segment=0.1)


def changed(dem, change):
    """The manifest with a change made to it."""
    manifest = json.loads(dem.read_text())
    change(manifest)
    dem.write_text(json.dumps(manifest))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda m: m["frames"].pop(3), "frame 3 .* follows frame 2 .*./run --force .*dem.json"),
        (
            lambda m: m["frames"].insert(6, m["frames"][6]),
            "frame 7 .* follows frame 6 ",
        ),
        (lambda m: m.update(frames=m["frames"][:1]), "lists 1 frames, at least 2 are needed"),
        (lambda m: m.pop("frame_interval_s"), "no readable manifest"),
    ],
)
def test_a_manifest_that_is_not_in_order_is_refused(bed, change, message):
    changed(bed[1], change)
    with pytest.raises(UserError, match=message):
        read_manifest(bed[1])


def test_a_store_of_another_shape_is_refused(bed):
    _, dem = bed
    files = dem.parent / "trajectory.npy", dem.parent / "trajectory.json"
    write_trajectory(dem, *files, 0.08, 0.2, progress=False)
    np.save(dem.parent / "trajectory.npy", np.zeros((3, 4, 20), np.float32))
    with pytest.raises(UserError, match=r"has the shape \(3, 4, 20\), \(9, 4, 20\) expected"):
        open_trajectory(*files)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda m: m["frames"][2].update(file="/etc/passwd"), "/etc/passwd is not within this folder"),
        (lambda m: m["frames"][2].update(file="../dem/frame_1.bin"), "is not within this folder"),
        (lambda m: m["segments"][0].update(folder="../other"), "../other is not within this folder"),
        (lambda m: m.update(gas="/dev/zero"), "/dev/zero is not within this folder"),
        (lambda m: m["frames"][2].update(file=7), "7 is no name of a file"),
        (lambda m: m["frames"][2].pop("file"), "no readable manifest"),
        (lambda m: m.update(segments=7), "no readable manifest"),
    ],
)
def test_names_of_a_manifest_stay_in_its_folder(bed, change, message):
    changed(bed[1], change)
    with pytest.raises(UserError, match=message):
        read_manifest(bed[1])


def test_a_pipe_in_place_of_a_frame_or_of_the_manifest_is_refused(bed):
    _, dem = bed
    frame = dem.parent / json.loads(dem.read_text())["frames"][3]["file"]
    frame.unlink()
    os.mkfifo(frame)
    with pytest.raises(UserError, match=f"{frame.name} is a special file"):
        read_manifest(dem)
    dem.unlink()
    os.mkfifo(dem)
    with pytest.raises(UserError, match="dem.json is a special file"):
        read_manifest(dem)
