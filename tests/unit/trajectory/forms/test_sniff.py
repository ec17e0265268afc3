# SPDX-License-Identifier: GPL-3.0-or-later
"""Forms by content, whatever the name of the file, and what an unknown content looks like."""

import gzip

import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.trajectory.forms.sniff import form_of, head_of
from made.forms import FORMS, VTK_BOX, moving, write_form

EXPECTED = {
    "crlf": "text", "gz": "text", "xz": "text", "many_text": "text", "lammps": "binary", "blanks": "table",
    "vtp": "vtk", "vtu": "vtk",
}  # fmt: skip


@pytest.mark.parametrize("form", FORMS)
def test_each_form_is_known_by_its_content(tmp_path, form):
    write_form(form, tmp_path, moving(n_frames=1))
    file = next(file for file in sorted(tmp_path.iterdir()))
    file = file.rename(tmp_path / "anything")
    assert form_of(head_of(file)[0]) == EXPECTED.get(form, form.split("_")[0])


@pytest.mark.parametrize(
    ("content", "look"),
    [
        (b"\x89HDF\r\n\x1a\n" + bytes(50), "HDF5"),
        ("ITEM: TIMESTEP\n".encode("utf-16"), "text in UTF-16"),
        (b"CDF\x01" + bytes(50), "NetCDF"),
        (gzip.compress(b"\x89HDF\r\n"), "HDF5"),
        (gzip.compress(gzip.compress(b"ITEM: TIMESTEP\n")), "gz inside a compressed file"),
        (b"BZh91AY", "bz2"),
        (b"\x93NUMPY\x01\x00", "a single array of numpy"),
        (b"\x01\x00\x00\xff" * 30, "binary data of another program"),
        (b"# a README of a folder\n", "text without numbers"),
    ],
)
def test_an_unknown_form_is_told_by_what_it_looks_like(tmp_path, content, look):
    (tmp_path / "file").write_bytes(content)
    with pytest.raises(DataError, match=f"looks like {look}.*"):
        form_of(head_of(tmp_path / "file")[0])


def test_empty_files_and_boxes_are_no_frames(tmp_path):
    (tmp_path / "empty").write_bytes(b"")
    assert form_of(head_of(tmp_path / "empty")[0]) is None and form_of(VTK_BOX) is None
    np.savez(tmp_path / "a.npz", x=np.zeros((2, 2)))
    assert form_of(head_of(tmp_path / "a.npz")[0]) == "npz"
