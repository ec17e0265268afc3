# SPDX-License-Identifier: GPL-3.0-or-later
"""Kinds of VTK files by their heads, and headers that announce more than the file holds."""

import pytest

from bedchain.errors import DataError
from bedchain.trajectory.forms.vtk import VtkKind, collection, kind_of, read_frame
from made.forms import VTK_BOX, legacy_vtk, moving

SERIES = moving(n_frames=1)


def load(tmp_path, content: bytes):
    file = tmp_path / "frame_0.vtk"
    file.write_bytes(content)
    return read_frame(file, kind_of(content), {}).load()


def test_kinds_and_numbers_of_points():
    assert kind_of(legacy_vtk(SERIES, 0)) == VtkKind("POLYDATA", 20)
    assert kind_of(VTK_BOX) == VtkKind("RECTILINEAR_GRID", None)
    assert kind_of(b'<?xml version="1.0"?><VTKFile type="Collection">') == VtkKind("Collection", None)
    assert kind_of(b"ITEM: TIMESTEP") is None
    with pytest.raises(DataError, match="without a line DATASET"):
        kind_of(b"# vtk DataFile Version 4.2\n")


@pytest.mark.parametrize("number", ["99999999999", "-1", "9" * 30])
@pytest.mark.parametrize("word", ["POINTS {} float", "VERTICES {} 40", "radius 1 {} double"])
def test_a_number_in_a_header_takes_no_memory(tmp_path, word, number):
    content = legacy_vtk(SERIES, 0).decode()
    assert word.format(20) in content
    with pytest.raises(DataError):
        load(tmp_path, content.replace(word.format(20), word.format(number)).encode())


def test_a_cut_file_is_refused(tmp_path):
    content = legacy_vtk(SERIES, 0)
    with pytest.raises(DataError, match="cut off or damaged|no number"):
        load(tmp_path, content[: content.index(b"v 3 20") + 40])


def test_a_collection_needs_times_and_files(tmp_path):
    file = tmp_path / "all.pvd"
    file.write_text(
        '<VTKFile type="Collection"><Collection><DataSet timestep="1" file="a.vtp"/></Collection></VTKFile>'
    )
    assert list(collection(file)) == [(1.0, tmp_path / "a.vtp")]
    for wrong in ('<DataSet file="a.vtp"/>', '<DataSet timestep="nan" file="a.vtp"/>', "<DataSet"):
        file.write_text(f'<VTKFile type="Collection"><Collection>{wrong}</Collection></VTKFile>')
        with pytest.raises(DataError, match="no readable collection"):
            list(collection(file))
