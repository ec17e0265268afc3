# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from bedchain.errors import DataError, UserError
from bedchain.trajectory.grid import OUTSIDE, Grid

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


CUBE = {"depth_m": 0.2, "layers": 4}
DEEP = [
    Grid(0.2, 0.3, 5, 6, **CUBE),
    Grid(0.2, 0.3, 5, 6, 0.2, form="rings"),
    Grid(0.2, 0.3, 5, 6, **CUBE, form="sectors"),
    Grid(0.2, 0.2, 5, 6, 0.3, 4, form="sectors", axis="horizontal"),
    Grid(0.2, 0.2, 5, 6, 0.3, form="rings", axis="horizontal"),
    Grid(0.2, 0.2, 5, 6, 0.3, form="sectors", axis="horizontal"),
    Grid(0.2, 0.3, 1, 6),
]


def in_the_bed(grid, number=5000, seed=4):
    """Places spread evenly over the box or the cylinder of a grid."""
    rng = np.random.default_rng(seed)
    x, z, y = (length * rng.random(number) for length in grid.size)
    if grid.form == "boxes":
        return x, z, y
    other = y if grid.axis == "vertical" else z
    inside = np.hypot(x - grid.width_m / 2, other - grid.width_m / 2) < grid.width_m / 2
    return x[inside], z[inside], y[inside]


@pytest.mark.parametrize("grid", DEEP)
def test_cells_of_every_form_hold_their_middles_and_number_layer_by_layer(grid):
    column, row, layer = grid.indices(np.arange(grid.n_cells))
    assert ((layer * grid.rows + row) * grid.columns + column == np.arange(grid.n_cells)).all()
    middles = [
        (i + 0.5) * (length / n)
        for i, length, n in zip((column, row, layer), grid.lengths_m, grid.counts, strict=True)
    ]
    x, z, y = grid.coordinates.place(*middles, grid.size)
    assert grid.cell_of(x, z, y_m=y).tolist() == list(range(grid.n_cells))
    np.testing.assert_allclose(grid.centres_m, np.column_stack((x, z)))
    assert Grid.from_arrays({name: np.array(value) for name, value in grid.arrays().items()}) == grid


@pytest.mark.parametrize("grid", DEEP)
def test_pictures_add_up_over_the_layers(grid):
    x, z, y = in_the_bed(grid)
    held = np.bincount(grid.cell_of(x, z, y_m=y), minlength=grid.n_cells)
    across, up = grid.picture(x, z, y)
    flat = grid.shown
    np.testing.assert_array_equal(
        grid.projected(held), np.bincount(flat.cell_of(across, up), minlength=flat.n_cells)
    )
    assert bool(grid.projection) == (grid.form != "boxes" or grid.layers > 1)


def test_a_grid_that_needs_y_asks_for_it():
    with pytest.raises(DataError, match="need the third axis, y: the frames have none"):
        DEEP[0].cell_of([0.1], [0.1])
    assert DEEP[5].cell_of([0.1], [0.05]).size == 1  # sectors of a drum without layers do not
    with pytest.raises(DataError, match=r"rings: they have no layers"):
        Grid(0.2, 0.3, 5, 6, 0.2, 2, form="rings")
    with pytest.raises(DataError, match=r"5 x 6 x 2 cells in a bed 0.0 m deep"):
        Grid(0.2, 0.3, 5, 6, layers=2)


def test_a_place_beyond_the_wall_of_a_cylinder_is_outside():
    with pytest.raises(DataError, match=r"particle 1 .*at r = 0.1"):
        DEEP[5].cell_of([0.1, 0.19], [0.1, 0.19])


def test_particles_that_are_not_there_or_left_are_outside():
    x = np.array([[0.1, np.nan, 0.1], [0.1, 0.1, 0.3]])
    cells = DEEP[-1].cells_seen(x, np.where(np.isnan(x), np.nan, 0.1), may_leave=True)
    assert cells.tolist() == [[2, OUTSIDE, 2], [2, 2, OUTSIDE]]
    with pytest.raises(DataError, match=r"particle 2 .*frame 8 .*x = 0.3 m, 0.1 m outside"):
        DEEP[-1].cells_seen(x, np.full(x.shape, 0.1), 7)
