# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of a pattern: their order and times, their box, what is passed over, joined or left out."""

import json
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from bedchain.errors import UserError
from bedchain.trajectory.forms.files import FormSettings
from bedchain.trajectory.frame_files import FrameSettings, files_of
from bedchain.trajectory.survey import cached_survey, check_even, rounded_outwards, survey
from made.forms import BOX, STEP_S, VTK_BOX, moving, text_frame, write_form

SERIES = moving()


def settings(pattern, **more) -> FrameSettings:
    return FrameSettings(str(pattern), step_s=STEP_S, **more)


def frames_in(tmp_path, **more):
    return survey(settings("*", **more), tmp_path)


def test_frames_are_in_the_order_of_their_steps_not_of_their_names(tmp_path):
    for frame, name in enumerate(("b2", "a10", "z1", "c", "d", "a9")):
        (tmp_path / name).write_text(text_frame(SERIES, frame))
    frames = frames_in(tmp_path)
    assert [Path(entry.file).name for entry in frames.entries] == ["b2", "a10", "z1", "c", "d", "a9"]
    assert [entry.time_s for entry in frames.entries] == [0, 0.01, 0.02, 0.03, 0.04, 0.05]
    assert frames.interval_s == 0.01 and frames.from_header and np.array(frames.box_m) == pytest.approx(BOX)
    assert (frames.number, frames.diameters_m) == (20, [1e-3] * 3)


def test_boxes_are_passed_over_and_repeated_steps_joined(tmp_path):
    write_form("text", tmp_path, SERIES)
    (tmp_path / "box_0.vtk").write_bytes(VTK_BOX)
    (tmp_path / "restart.dump").write_text(text_frame(SERIES, 4) + text_frame(SERIES, 5))
    empty = text_frame(SERIES, 0).split("\n")
    empty[3] = "0"
    (tmp_path / "empty.dump").write_text("\n".join(empty[:9]) + "\n")
    frames = frames_in(tmp_path)
    assert len(frames.entries) == 6 and frames.entries[-1].file.endswith("restart.dump")
    assert frames.notes == [
        "1 files that hold no particles were passed over",
        "1 empty frames were skipped",
        "2 frames were there twice, of which the later ones were taken",
    ]


def test_a_cut_last_frame_is_left_out_with_a_note(tmp_path):
    (tmp_path / "all").write_text("".join(text_frame(SERIES, frame) for frame in range(4))[:-20])
    frames = frames_in(tmp_path)
    assert len(frames.entries) == 3
    assert "left out: " in frames.notes[0] and "step 3000 is cut off: 19 of 20 particles" in frames.notes[0]


@pytest.mark.parametrize("form", ["vtk", "vtp"])
def test_a_cut_last_file_of_vtk_is_left_out_too(tmp_path, form):
    write_form(form, tmp_path, SERIES)
    last = files_of("*", tmp_path)[-1]
    last.write_bytes(last.read_bytes()[:-500])
    frames = frames_in(tmp_path)
    assert len(frames.entries) == 5 and "left out, the last frame" in frames.notes[0]


def test_without_a_box_in_the_files_it_is_that_of_the_particles_with_their_radii(tmp_path):
    write_form("vtk", tmp_path, SERIES)
    frames = frames_in(tmp_path)
    low, high = np.array(frames.box_m).T
    assert not frames.from_header
    assert (low <= SERIES.positions.min(axis=(0, 1)) - 4.9e-4).all()
    assert (high >= SERIES.positions.max(axis=(0, 1)) + 4.9e-4).all()
    assert (low >= SERIES.positions.min(axis=(0, 1)) - 8e-4).all()


def test_units_and_a_stretch_of_steps(tmp_path):
    write_form("text", tmp_path, SERIES)
    frames = frames_in(tmp_path, length_unit_m=0.001, first_step=2000, last_step=4000)
    assert [entry.step for entry in frames.entries] == [2000, 3000, 4000] and frames.start_s == 0.02
    assert frames.box_m[0] == pytest.approx([-5e-5, 5e-5])


def test_uneven_frames_are_refused_with_the_factor(tmp_path):
    write_form("text", tmp_path, SERIES)
    check_even(frames_in(tmp_path))
    (tmp_path / "frame_3000.dump").unlink()
    with pytest.raises(UserError, match=r"frame_4000.dump \(step 4000\) is 2 intervals of 0.01 s after"):
        check_even(frames_in(tmp_path))
    with pytest.raises(UserError, match="a single frame"):
        check_even(frames_in(tmp_path, last_step=0))


def test_frames_without_a_clock_are_asked_for_one(tmp_path):
    write_form("text", tmp_path, SERIES)
    with pytest.raises(UserError, match=r"step 0, and no time: give frames.step_s"):
        survey(FrameSettings("*"), tmp_path)
    (tmp_path / "one").mkdir()
    (tmp_path / "one" / "a.csv").write_text("id,x,z\n1,2,3\n")
    with pytest.raises(UserError, match="no number in its name"):
        survey(FrameSettings("one/*", step_s=1.0), tmp_path)


def test_files_without_any_frame_are_refused(tmp_path):
    (tmp_path / "box_0.vtk").write_bytes(VTK_BOX)
    with pytest.raises(UserError, match="1 files, and no frame with particles in them"):
        frames_in(tmp_path)


def test_a_survey_is_kept_until_a_file_or_a_setting_changes(tmp_path, monkeypatch):
    write_form("binary", tmp_path / "data", SERIES)
    names = ("id", "type", "x", "y", "z", "vx", "vy", "vz", "radius")
    chosen = settings("data/*", reading=FormSettings(names=names))
    cache = tmp_path / "frames.json"
    first = cached_survey(chosen, tmp_path, cache)
    kept = json.loads(cache.read_text())
    kept["survey"]["number"] = 77
    cache.write_text(json.dumps(kept))
    assert cached_survey(chosen, tmp_path, cache) == first._replace(number=77)
    assert cached_survey(replace(chosen, last_step=3000), tmp_path, cache).number == 20
    cached_survey(chosen, tmp_path, cache)
    os.utime(tmp_path / "data" / "frame_0.bin", ns=(1, 1))
    kept = json.loads(cache.read_text())
    kept["survey"]["number"] = 77
    cache.write_text(json.dumps(kept))
    assert cached_survey(chosen, tmp_path, cache).number == 20


def test_spans_are_rounded_outwards():
    low, high = rounded_outwards(-0.041991900318861006, 0.037881001496315)
    assert (low, high) == (-0.042, 0.0379) or (
        low <= -0.0419919 and high >= 0.0378810 and high - low < 0.0802
    )
    assert rounded_outwards(0.0, 0.0) == (0.0, 0.0)
    assert rounded_outwards(0.0, 5e-310) == (0.0, 5e-310)  # of a damaged file
