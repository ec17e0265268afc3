# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays of numpy in the ways that people save them, and arrays that do not fit."""

import zipfile

import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.trajectory.forms.npz import read_frames

X = np.arange(12.0).reshape(4, 3)


def read(tmp_path, save=np.savez, **arrays):
    save(tmp_path / "a.npz", **arrays)
    return list(read_frames(tmp_path / "a.npz"))


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_positions_columns_and_named_axes_are_the_same(tmp_path, save):
    ways = (
        {"positions": np.stack((X, 2 * X), axis=2), "times_s": np.arange(4)},
        {"x": X, "z": 2 * X, "t": np.arange(4)},
        {"x_z": np.stack((X, 2 * X), axis=1), "times": np.arange(4), "ids": np.array([5, 6, 7])},
    )
    for arrays in ways:
        frames = read(tmp_path, save, **arrays)
        assert [frame.time for frame in frames] == [0, 1, 2, 3]
        assert frames[2].load()["z"].tolist() == (2 * X[2]).tolist()


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        ({"mass": X}, "no positions among its arrays"),
        ({"x": X, "z": X[:2]}, "z has the shape"),
        ({"x": X, "z": X, "times": np.arange(3)}, "finite numbers for 4 frames expected"),
        ({"x": X, "z": X, "times": np.full(4, np.nan)}, "finite numbers for 4 frames expected"),
        ({"x": X, "z": np.full((4, 3), "a")}, "z: no numbers"),
        ({"x": X, "z": np.full((4, 3), None)}, "holds Python objects"),
    ],
)
def test_arrays_that_do_not_fit_are_refused(tmp_path, arrays, message):
    with pytest.raises(DataError, match=message):
        read(tmp_path, **arrays)


def test_a_shape_in_a_header_takes_no_memory(tmp_path):
    np.savez(tmp_path / "a.npz", x=X)
    content = (tmp_path / "a.npz").read_bytes().replace(b"(4, 3), ", b"(4, 3000000000000), ")
    with zipfile.ZipFile(tmp_path / "b.npz", "w") as archive:
        archive.writestr("x.npy", content[content.index(b"\x93NUMPY") :][:200])
    with pytest.raises(DataError, match=r"announces|no readable"):
        list(read_frames(tmp_path / "b.npz"))
