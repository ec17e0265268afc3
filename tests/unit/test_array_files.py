# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays are read where header and file agree; a number in a header takes no memory."""

import zipfile
from io import BytesIO

import numpy as np
import pytest
from numpy.lib import format as npy_format

from bedchain.array_files import map_array, map_npy, read_arrays
from bedchain.errors import DataError


def npy(shape, values=b"", descr="<f8"):
    """Bytes of an .npy with any header."""
    stream = BytesIO()
    npy_format.write_array_header_1_0(stream, {"descr": descr, "fortran_order": False, "shape": shape})
    return stream.getvalue() + values


def test_arrays_that_cannot_be_mapped_are_refused(tmp_path):
    path = tmp_path / "some.npz"
    np.savez_compressed(path, a=np.ones(3))
    with pytest.raises(DataError, match="is compressed"):
        map_array(path, "a")
    with pytest.raises(DataError, match="no array 'b'"):
        map_array(path, "b")
    with pytest.raises(DataError, match="no array"):
        map_array(tmp_path / "absent.npz", "a")


def test_an_npy_is_mapped(tmp_path):
    np.save(tmp_path / "a.npy", np.arange(6).reshape(2, 3))
    assert map_npy(tmp_path / "a.npy").tolist() == [[0, 1, 2], [3, 4, 5]]


@pytest.mark.parametrize(
    "content",
    [
        npy((10**12,), b"12345678"),
        npy((2**40, 2**40), b"12345678"),
        npy((2,), b"12345678"),
        npy((1,), b"123456789"),
        npy((-1, -1), b"12345678"),
        npy((10**15,), descr="<U0"),
        npy((1,), b"12345678", "|O"),
        npy((1,), b"12345678")[:40],
        b"",
    ],
)
def test_a_header_that_does_not_fit_the_file_is_refused(tmp_path, content):
    """In less memory than a shape asks for: 8 TB."""
    (tmp_path / "a.npy").write_bytes(content)
    with zipfile.ZipFile(tmp_path / "a.npz", "w") as archive:
        archive.writestr("a.npy", content)
    for read, file in (
        (map_npy, "a.npy"),
        (read_arrays, "a.npz"),
        (lambda path: map_array(path, "a"), "a.npz"),
    ):
        with pytest.raises(DataError, match=rf"{file}.*make it again: ./run --force"):
            read(tmp_path / file)


def test_an_array_that_is_not_there_is_a_sentence(tmp_path):
    np.savez(tmp_path / "a.npz", a=np.ones(3))
    with pytest.raises(DataError, match=r"a.npz holds no array 'b'; make it again"):
        read_arrays(tmp_path / "a.npz")["b"]
