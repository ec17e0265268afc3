# SPDX-License-Identifier: GPL-3.0-or-later
"""LIGGGHTS's own VTK files: the same as VTK reads them, and damage told by what is there."""

import numpy as np
import pytest
import pyvista

from bedchain.errors import DataError
from bedchain.trajectory.forms.legacy_vtk import is_early, read_values
from made.forms import VTK_BOX, legacy_vtk, moving

SERIES = moving(n_frames=1)


@pytest.mark.parametrize("ascii_form", [True, False])
def test_values_are_those_that_vtk_reads(tmp_path, ascii_form):
    content = legacy_vtk(SERIES, 0, ascii_form)
    (tmp_path / "a.vtk").write_bytes(content)
    mesh, values = pyvista.read(tmp_path / "a.vtk"), read_values(content)
    assert is_early(content)
    np.testing.assert_allclose(values.points, mesh.points, rtol=1e-6)
    assert set(values.fields) == set(mesh.point_data)
    for name, array in values.fields.items():
        np.testing.assert_allclose(np.squeeze(array), mesh[name], rtol=1e-12)


@pytest.mark.parametrize("ascii_form", [True, False])
@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b"POINTS 20 ", b"POINTS 21 "), (b"POINTS 20 ", b"POINTS 99999999999 "),
        (b"id 1 20 int", b"id 1 19 int"),
        (b"v 3 20 double", b"v 3 20 wide"), (b"v 3 20 double", b"v 300 20 double"), (b"POINTS", b"PINTS"),
    ],
)  # fmt: skip
def test_a_header_with_a_fault_is_refused(old, new, ascii_form):
    content = legacy_vtk(SERIES, 0, ascii_form)
    assert old in content
    with pytest.raises(DataError):
        read_values(content.replace(old, new))


@pytest.mark.parametrize("ascii_form", [True, False])
@pytest.mark.parametrize("kept", [70, 100, 300, -20, -200])
def test_a_cut_file_is_refused(kept, ascii_form):
    with pytest.raises(DataError):
        read_values(legacy_vtk(SERIES, 0, ascii_form)[:kept])


def test_scalars_and_vectors_are_read_too():
    text = (
        b"# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0 1 2 3 4 5\nPOINT_DATA 2\n"
    )
    text += b"SCALARS id int 1\nLOOKUP_TABLE default\n7 8\nVECTORS v double\n1 2 3\n4 5 6\n"
    values = read_values(text)
    assert values.fields["id"].ravel().tolist() == [7, 8]
    assert values.fields["v"].tolist() == [[1, 2, 3], [4, 5, 6]]


def test_a_box_has_no_particles():
    with pytest.raises(DataError):
        read_values(VTK_BOX)
