# SPDX-License-Identifier: GPL-3.0-or-later
"""VTK in a process of its own: its death and its silence are sentences, and the next file is read."""

import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.trajectory.forms.vtk_process import VtkProcess
from made.forms import moving, write_form

SERIES = moving(n_frames=1)


@pytest.fixture(scope="module")
def process():
    yield (process := VtkProcess())
    process.close()


def test_a_file_over_which_vtk_dies_is_a_sentence_and_the_next_one_is_read(process, tmp_path):
    write_form("vtk_5_binary", tmp_path, SERIES)
    file = tmp_path / "frame_0.vtk"
    whole = file.read_bytes()
    file.write_bytes(whole.replace(b"Version 5.1", b"Version 5.!"))
    with pytest.raises(DataError, match="VTK breaks down over it"):
        process.read(file)
    file.write_bytes(whole)
    values = process.read(file)
    np.testing.assert_allclose(values.points, SERIES.positions[0], rtol=1e-6)
    np.testing.assert_array_equal(values.fields["ID"], SERIES.ids)
    assert values.fields["Velocity"].shape == (20, 3)


def test_what_vtk_says_is_passed_on(process, tmp_path):
    (file := tmp_path / "frame_0.vtp").write_text('<?xml version="1.0"?><VTKFile type="PolyData"><Poly')
    with pytest.raises(DataError, match="VTK cannot read it"):
        process.read(file)
