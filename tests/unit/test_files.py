# SPDX-License-Identifier: GPL-3.0-or-later
import os
from pathlib import Path

import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.files import map_array, path_inside, read_arrays, refuse_special_file, write_arrays


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


@pytest.mark.parametrize(
    "name", ["a.bin", "dem/segment_0001", "absent/frame.bin", "./a.bin", "..a/b", "loop/a.bin"]
)
def test_paths_within_a_folder_pass_even_where_the_folder_is_a_link(tmp_path, name):
    (tmp_path / "disk").mkdir()
    (tmp_path / "disk" / "a.bin").touch()
    (tmp_path / "disk" / "loop").symlink_to(tmp_path / "disk")
    (tmp_path / "results").symlink_to(tmp_path / "disk")
    assert path_inside(tmp_path / "results", name) == tmp_path / "results" / name


@pytest.mark.parametrize(
    "name", ["/etc/passwd", "../a.bin", "dem/../../a.bin", "", None, 3, "a\0b", "a" * 5000]
)
def test_names_that_are_no_relative_path_are_refused(tmp_path, name):
    with pytest.raises(DataError, match="make the manifest again"):
        path_inside(tmp_path, name)


def test_links_out_of_the_folder_and_in_circles_are_refused(tmp_path):
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "out").symlink_to(tmp_path)
    (tmp_path / "run" / "circle").symlink_to("circle")
    for name in ("out", "out/frame.bin"):
        with pytest.raises(DataError, match="is a link to"):
            path_inside(tmp_path / "run", name)
    with pytest.raises(DataError, match="cannot be reached"):
        path_inside(tmp_path / "run", "circle")


def test_special_files_are_refused_before_they_are_opened(tmp_path):
    os.mkfifo(tmp_path / "frame.bin")
    with pytest.raises(DataError, match=r"frame.bin is a special file \(pipe, socket or device\)"):
        path_inside(tmp_path, "frame.bin")
    with pytest.raises(DataError, match="is a special file"):
        refuse_special_file(Path("/dev/zero"))
