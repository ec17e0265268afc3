# SPDX-License-Identifier: GPL-3.0-or-later
"""Heat to the walls on a chain of a made-up bed: shares of cells beside walls, limits, and the figure."""

import numpy as np
import pandas as pd
import pytest

from bedchain.chains import registry, static
from bedchain.chains.counting import count_moves
from bedchain.errors import UserError
from bedchain.trajectory.grid import Grid
from made.drawings import DPI, CheckedFiles
from plot_scalar import beside_wall, plot_scalar, static_chain

GRID = Grid(0.12, 0.16, 6, 8)
COLOURS = {"static": "#ee6677"}


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    """A static chain of particles that step to neighbours."""
    rng = np.random.default_rng(3)
    steps = rng.integers(-1, 2, (2, 60, 2000))
    start = np.array([rng.integers(0, 6, 2000), rng.integers(0, 8, 2000)])[:, None]
    column, row = start + steps.cumsum(axis=1)
    cells = (np.clip(row, 0, 7) * 6 + np.clip(column, 0, 5)).astype(np.int32)
    chain = static.from_counts(count_moves(cells, GRID.n_cells, 1), GRID, 0.1)
    path = tmp_path_factory.mktemp("scalar") / "transitions_static.npz"
    registry.save(chain, path)
    return path


def test_cells_beside_a_wall_count_by_their_share():
    shares = beside_wall(GRID, 0.03).reshape(8, 6)
    np.testing.assert_allclose(shares, [[1, 0.5, 0, 0, 0.5, 1]] * 8)


def test_the_figure_has_both_limits(file, tmp_path):
    files = CheckedFiles(*(tmp_path / f"fig.{form}" for form in ("png", "pdf", "csv")), DPI)
    plot_scalar([file], files, 1.0, 0.03, COLOURS)
    table = pd.read_csv(files.csv)
    assert files.png.exists() and (table["bed_loss_1_s"].diff().dropna() > 0).all()
    assert table["bed_loss_1_s"][0] == pytest.approx(table["well_mixed_1_s"][0], rel=0.01)
    assert table["bed_loss_1_s"].iloc[-1] < 0.1 * table["well_mixed_1_s"].iloc[-1]


def test_a_chain_with_other_states_is_refused(file, tmp_path):
    chain = registry.load(file)
    other = type(chain)(**{**vars(chain), "grid": Grid(0.12, 0.16, 6, 4)})
    registry.save(other, tmp_path / "transitions_dynamic.npz")
    with pytest.raises(UserError, match="static chains"):
        static_chain(tmp_path / "transitions_dynamic.npz")
