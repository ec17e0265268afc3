# SPDX-License-Identifier: GPL-3.0-or-later
"""Every form gives the same frames, and a fault of a file names the file."""

from pathlib import Path

import pytest

from bedchain.errors import DataError
from bedchain.trajectory.forms.files import FormSettings, frames_of, step_in_name
from bedchain.trajectory.forms.raw import CutOffError
from bedchain.trajectory.frame_files import files_of
from made.forms import COLUMNS, FORMS, STEP_S, VTK_BOX, moving, text_frame, write_form

NINE_DIGITS, SINGLE = 1e-8, 1e-6  # of a text of nine digits, and of VTK's points


def read(pattern: str, form: str) -> list:
    settings = FormSettings(names=COLUMNS if form == "binary" else None)
    return [frame for file in files_of(pattern, Path()) for frame in frames_of(file, settings)]


@pytest.mark.parametrize("form", FORMS)
def test_all_forms_give_the_same_frames(tmp_path, form):
    series = moving(n_frames=3)
    frames = read(write_form(form, tmp_path, series), form)
    assert len(frames) == 3
    for at, frame in enumerate(frames):
        clock = frame.step if frame.step is not None else frame.time / STEP_S
        assert clock == pytest.approx(series.steps[at])
        values = frame.load()
        assert (
            values["id"].tolist() == series.ids.tolist() and values["type"].tolist() == series.types.tolist()
        )
        for axis, name in enumerate("xyz"):
            assert values[name] == pytest.approx(series.positions[at, :, axis], abs=1e-9, rel=SINGLE)
            assert values[f"v{name}"] == pytest.approx(series.velocities[at, :, axis], rel=NINE_DIGITS)
        radii = values["radius"] if "radius" in values else values["diameter"] / 2
        assert radii == pytest.approx(series.radii)


def test_binary_forms_are_exact(tmp_path):
    series = moving(n_frames=1)
    for form in ("binary", "lammps", "npz"):
        (frame,) = read(write_form(form, tmp_path / form, series), form)
        assert (frame.load()["x"] == series.positions[0, :, 0]).all()


def test_a_file_of_a_box_has_no_frames(tmp_path):
    (tmp_path / "boundingBox_0.vtk").write_bytes(VTK_BOX)
    assert list(frames_of(tmp_path / "boundingBox_0.vtk", FormSettings())) == []


def test_a_cut_frame_gives_those_before_it_and_names_the_file(tmp_path):
    series = moving(n_frames=2)
    (tmp_path / "all.dump").write_text(text_frame(series, 0) + text_frame(series, 1)[:-30])
    frames = frames_of(tmp_path / "all.dump", FormSettings())
    next(frames)
    with pytest.raises(CutOffError, match=r"all.dump: the frame of step 1000 is cut off: 19 of 20 particles"):
        next(frames)


def test_a_file_that_cannot_be_read_is_named(tmp_path):
    with pytest.raises(DataError, match=r"gone.dump is no file"):
        list(frames_of(tmp_path / "gone.dump", FormSettings()))
    with pytest.raises(DataError, match=r"but a folder: name its files"):
        list(frames_of(tmp_path, FormSettings()))


def test_steps_in_names():
    names = {"drum_12000.vtk": 12000, "a1_0400.dump.gz": 400, "frame.csv": None, "p000007": 7, "x.12.vtp": 12}
    assert {name: step_in_name(Path(name)) for name in names} == names
