# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from bedchain.errors import DataError, UserError
from bedchain.trajectory.grid import Grid

PAPER = Grid(0.27, 1.05, 27, 105)


def test_cells_are_numbered_from_the_bottom_left_row_by_row():
    grid = Grid(3.0, 2.0, 3, 2)
    x, z = grid.centres_m.T
    assert grid.cell_of(x, z).tolist() == [0, 1, 2, 3, 4, 5]
    assert grid.cell_of(x, z).dtype == np.int32
    assert grid.centres_m[4].tolist() == [1.5, 1.5]
    assert grid.x_edges_m.tolist() == [0, 1, 2, 3] and grid.z_edges_m.tolist() == [0, 1, 2]


def test_inner_edges_belong_to_the_higher_cell_and_walls_to_the_last():
    grid = Grid(1.0, 1.0, 4, 4)
    assert grid.cell_of([0.25, 1.0, 0.0], [0.0, 1.0, 0.5]).tolist() == [1, 15, 8]


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_agrees_with_a_loop_over_random_positions(dtype):
    rng = np.random.default_rng(11)
    x, z = (rng.random((3, 500)) * 0.27).astype(dtype), (rng.random((3, 500)) * 1.05).astype(dtype)
    cells = PAPER.cell_of(x, z)
    for where in np.ndindex(x.shape):
        column = max(c for c in range(27) if c * PAPER.cell_width_m <= float(x[where]) * (1 + 1e-15))
        row = max(r for r in range(105) if r * PAPER.cell_height_m <= float(z[where]) * (1 + 1e-15))
        assert cells[where] == row * 27 + column


def test_a_float32_just_below_an_edge_stays_below():
    edges = np.arange(1, 27) * PAPER.cell_width_m
    stored = edges.astype(np.float32)
    below = stored.astype(float) < edges
    assert below.any()
    found = PAPER.cell_of(stored[below], np.zeros(below.sum(), np.float32))
    assert found.tolist() == np.flatnonzero(below).tolist()


def test_the_wall_itself_as_float32_is_inside():
    assert PAPER.cell_of(np.array([0.27], np.float32), np.array([1.05], np.float32)).tolist() == [
        27 * 105 - 1
    ]


def test_a_position_outside_names_particle_frame_and_distance():
    x = np.full((4, 5), 0.1)
    z = np.full((4, 5), 0.2)
    x[2, 3] = 0.275
    with pytest.raises(DataError, match=r"particle 3 .*frame 12 .*x = 0\.275 m, 0\.005 m outside"):
        PAPER.cell_of(x, z, first_frame=10)
    with pytest.raises(DataError, match=r"particle 0 .*z = -0\.1 m, 0\.1 m outside"):
        PAPER.cell_of([0.1], [-0.1])
    with pytest.raises(UserError, match="x = nan"):
        PAPER.cell_of([np.nan], [0.1])


def test_from_one_cell_to_one_a_diameter():
    assert Grid(0.27, 1.05, 1, 1).cell_of([0.2], [1.0]).tolist() == [0]
    fine = Grid(0.27, 1.05, 270, 1050)
    fine.check_resolution(1e-3)
    assert fine.n_cells == 283_500
    with pytest.raises(DataError, match=r"271 columns .*at most 270"):
        Grid(0.27, 1.05, 271, 1050).check_resolution(1e-3)


@pytest.mark.parametrize(
    ("sizes", "message"),
    [
        ((0.0, 1.0, 1, 1), "both sizes must be positive"),
        ((1.0, float("nan"), 1, 1), "both sizes must be positive"),
        ((1.0, 1.0, 0, 1), "at least 1 x 1 is needed"),
        ((1, 1, 10**5, 10**5), "must fit in int32"),
    ],
)
def test_impossible_grids_are_refused(sizes, message):
    with pytest.raises(DataError, match=message):
        Grid(*sizes)
