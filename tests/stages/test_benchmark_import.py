# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark of the import: its made-up files hold the same frames in every form."""

import numpy as np
import pytest

import benchmark_import
from bedchain.trajectory.forms.files import FormSettings
from bedchain.trajectory.frame_files import FrameSettings, loaded
from bedchain.trajectory.survey import survey


@pytest.mark.parametrize("form", benchmark_import.FORMS)
def test_each_form_holds_the_same_frames(tmp_path, form):
    benchmark_import.write_files(form, tmp_path / "files", 30, 6)
    settings = FrameSettings(
        f"{tmp_path}/files/*", benchmark_import.STEP_S, reading=FormSettings(names=benchmark_import.COLUMNS)
    )
    frames = survey(settings, tmp_path)
    assert [entry.step for entry in frames.entries] == [1250 * frame for frame in range(6)]
    expected = benchmark_import.tables(30)
    for frame, (_, values) in enumerate(loaded(frames.entries, settings)):
        for at, name in enumerate(benchmark_import.COLUMNS):
            np.testing.assert_allclose(values[name], expected[frame % 4][:, at], rtol=1e-5, atol=1e-9)


def test_a_form_is_measured_in_a_process_of_its_own(tmp_path):
    benchmark_import.write_files("text", tmp_path / "files", 200, 4)
    numbers = benchmark_import.measure("text", tmp_path / "files")
    assert numbers.keys() | {"form", "frames"} == set(benchmark_import.FIELDS)
    assert numbers["files_mb"] == pytest.approx(0.044, rel=0.1)
    assert (tmp_path / "out" / "trajectory.npy").exists()
