# SPDX-License-Identifier: GPL-3.0-or-later
"""The batch, its distribution, and the table of costs, by hand."""

import numpy as np
import pandas as pd
import pytest

from bedchain.errors import UserError
from bedchain.figures.style import shown_height
from bedchain.measures.batch import batch_of, observed_shares, share_by_cell
from bedchain.trajectory.cell_store import CellStore, frame_at, open_cells, write_cells
from bedchain.trajectory.grid import Grid

GRID = Grid(0.02, 0.03, 2, 3)


def test_batch_is_the_lowest_rows():
    cells = np.array([0, 1, 2, 3, 4, 5])
    np.testing.assert_array_equal(batch_of(GRID, cells, 0.01), [1, 1, 0, 0, 0, 0])
    np.testing.assert_array_equal(batch_of(GRID, cells, 0.019), [1, 1, 1, 1, 0, 0])
    # lower than a row is still one row
    np.testing.assert_array_equal(batch_of(GRID, cells, 0.001), [1, 1, 0, 0, 0, 0])


def test_empty_batch_is_refused():
    with pytest.raises(UserError, match="batch_height_m"):
        batch_of(GRID, np.array([4, 5]), 0.01)


def test_shares_by_hand():
    np.testing.assert_array_equal(share_by_cell(np.array([0, 0, 5, 2]), 6), [0.5, 0, 0.25, 0, 0, 0.25])


def test_observed_shares_follow_the_batch_only():
    cells = np.array([[0, 1, 4], [2, 1, 4], [2, 3, 0]], np.int32)
    store = CellStore(cells, np.array([1.0, 1.5, 2.0]), GRID)
    shares = observed_shares(store, np.array([0.5, 1.0]), 1.0, 0.01)
    np.testing.assert_array_equal(shares, [[0, 0.5, 0.5, 0, 0, 0], [0, 0, 0.5, 0.5, 0, 0]])


def test_frame_at_takes_the_nearest_but_no_stranger():
    times = np.array([0.0, 0.1, 0.2])
    assert frame_at(times, 0.1 + 1e-9) == 1
    with pytest.raises(UserError, match="no frame at 0.3 s"):
        frame_at(times, 0.3)


def test_shown_height_is_whole_rows_within_the_bed():
    assert shown_height(np.array([0, 1]), GRID) == pytest.approx(0.02)
    assert shown_height(np.array([5]), GRID) == pytest.approx(0.03)


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
