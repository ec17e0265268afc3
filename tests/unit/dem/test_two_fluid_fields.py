# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields that OpenFOAM wrote as binary, and its order of faces."""

import numpy as np
import pytest

from bedchain.dem.two_fluid_fields import read_scalars, read_vectors, split_faces
from bedchain.errors import DataError

HEAD = b"FoamFile { format binary; }\ndimensions [0 0 0 0 0 0 0];\n\ninternalField   "


def test_values_of_a_binary_field_and_of_a_uniform_one(tmp_path):
    file = tmp_path / "alpha.particles"
    values = np.array([0.1, 0.2, 0.55])
    file.write_bytes(HEAD + b"nonuniform List<scalar> \n3\n(" + values.tobytes() + b");\n\nboundaryField {}")
    np.testing.assert_array_equal(read_scalars(file, 3), values)
    with pytest.raises(DataError, match="holds 3 values or is cut off, 4 expected"):
        read_scalars(file, 4)
    file.write_bytes(file.read_bytes()[: len(HEAD) + 40])
    with pytest.raises(DataError, match="is cut off"):
        read_scalars(file, 3)
    file.write_bytes(HEAD + b"uniform 0.25;")
    np.testing.assert_array_equal(read_scalars(file, 2), [0.25, 0.25])
    file.write_bytes(b"nothing")
    with pytest.raises(DataError, match="no scalar field"):
        read_scalars(file, 2)


def test_vectors_of_a_binary_field_and_of_a_uniform_one(tmp_path):
    file = tmp_path / "U.particles"
    values = np.arange(6.0).reshape(2, 3)
    file.write_bytes(HEAD + b"nonuniform List<vector> \n2\n(" + values.tobytes() + b");\n")
    np.testing.assert_array_equal(read_vectors(file, 2), values)
    with pytest.raises(DataError, match="holds 2 values or is cut off, 3 expected"):
        read_vectors(file, 3)
    file.write_bytes(HEAD + b"uniform (0 -1.5e-3 2);")
    np.testing.assert_array_equal(read_vectors(file, 2), [[0, -1.5e-3, 2]] * 2)


def test_faces_by_their_lower_cell_then_by_their_upper_one():
    # two rows of three cells: faces 0-1, 0-3, 1-2, 1-4, 2-5, 3-4, 4-5
    right, up = split_faces(np.arange(7.0), 2, 3)
    np.testing.assert_array_equal(right, [[0, 2], [5, 6]])
    np.testing.assert_array_equal(up, [[1, 3, 4]])
