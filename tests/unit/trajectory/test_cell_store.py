# SPDX-License-Identifier: GPL-3.0-or-later
"""The file of cells: chunks, the nearest frame, broken files."""

import numpy as np
import pandas as pd
import pytest

from bedchain.errors import UserError
from bedchain.trajectory.cell_store import frame_at, open_cells, write_cells
from bedchain.trajectory.grid import Grid

GRID = Grid(0.02, 0.03, 2, 3)


def test_frame_at_takes_the_nearest_but_no_stranger():
    times = np.array([0.0, 0.1, 0.2])
    assert frame_at(times, 0.1 + 1e-9) == 1
    with pytest.raises(UserError, match="no frame at 0.3 s"):
        frame_at(times, 0.3)


@pytest.mark.parametrize("chunk", [1, 7, 10_000])
def test_cells_written_in_chunks_are_the_same(tmp_path, monkeypatch, chunk):
    monkeypatch.setattr("bedchain.trajectory.cell_store.CHUNK_VALUES", chunk)
    rng = np.random.default_rng(2)
    trajectory = rng.uniform(0, [[0.02], [0.03], [1], [1]], (6, 4, 5)).astype(np.float32)
    write_cells(trajectory, np.arange(6.0), GRID, tmp_path / "c.npz")
    expected = (trajectory[:, 1] // 0.01).astype(int) * 2 + (trajectory[:, 0] // 0.01).astype(int)
    np.testing.assert_array_equal(open_cells(tmp_path / "c.npz").cells, expected)
    assert [path.name for path in tmp_path.iterdir()] == ["c.npz"]


def test_broken_cells_file_is_refused(tmp_path):
    (tmp_path / "c.npz").write_bytes(b"PK\x03\x04 cut off")
    with pytest.raises(UserError, match="not readable as cells"):
        open_cells(tmp_path / "c.npz")
    pd.DataFrame({"a": [1]}).to_csv(tmp_path / "d.npz")
    with pytest.raises(UserError, match="not readable as cells"):
        open_cells(tmp_path / "d.npz")
