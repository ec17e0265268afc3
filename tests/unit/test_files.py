# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.files import map_array, read_arrays, write_arrays


def test_arrays_come_back_exactly(tmp_path):
    path = tmp_path / "some.npz"
    arrays = {
        "a": np.arange(6, dtype=np.int32).reshape(2, 3),
        "b": np.array([np.pi, np.nan]),
        "c": np.array("text"),
    }
    write_arrays(path, arrays)
    again = read_arrays(path)
    for name, array in arrays.items():
        assert again[name].dtype == array.dtype and again[name].tobytes() == array.tobytes()
    assert map_array(path, "a").tolist() == [[0, 1, 2], [3, 4, 5]]


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "some.npz"
    write_arrays(path, {"a": np.ones(3)})
    before = path.read_bytes()
    with pytest.raises(ValueError, match="[Oo]bject arrays"):
        write_arrays(path, {"a": np.zeros(1000), "odd": np.array([object()])})
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_arrays_that_cannot_be_mapped_are_refused(tmp_path):
    path = tmp_path / "some.npz"
    np.savez_compressed(path, a=np.ones(3))
    with pytest.raises(DataError, match="compressed and cannot be mapped"):
        map_array(path, "a")
    with pytest.raises(DataError, match="no array 'b'"):
        map_array(path, "b")
    with pytest.raises(DataError, match="cannot be read|no array"):
        map_array(tmp_path / "absent.npz", "a")
