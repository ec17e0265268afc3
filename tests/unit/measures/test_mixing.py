# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.measures import mixing
from bedchain.trajectory.grid import Grid


def test_sides_by_hand():
    marked = mixing.sides(np.array([0.1, 0.2, 0.3]), np.array([0.5, 0.6, 0.4]), 0.2, 0.5)
    assert marked.tolist() == [
        [True, False, False],
        [False, True, True],
        [False, False, True],
        [True, True, False],
    ]


def test_a_split_through_a_column_takes_its_part_of_the_area():
    paper = Grid(0.27, 1.05, 27, 105)
    left, right, low, up = mixing.side_shares(paper, 0.135, 0.25)
    assert left[12:15].tolist() == pytest.approx([1.0, 0.5, 0.0])
    assert left[27 * 40 + 13] == pytest.approx(0.5)
    assert (left + right == 1).all() and (low + up == 1).all()
    # A split on an edge cuts nothing, whatever the rounding of the edges.
    assert set(np.unique(low)) == {0.0, 1.0} and low.sum() == 25 * 27
    third = mixing.side_shares(Grid(3.0, 1.0, 3, 1), 1.25, 0.5)[0]
    assert third.tolist() == [1.0, 0.25, 0.0]
    with pytest.raises(DataError, match="z = 2 m leaves one side empty"):
        mixing.side_shares(paper, 0.1, 2.0)


def test_area_rule_agrees_with_even_points_in_the_cells():
    grid = Grid(0.9, 0.7, 4, 3)
    x, z = (
        points.ravel()
        for points in np.meshgrid((np.arange(360) + 0.5) * 0.9 / 360, (np.arange(210) + 0.5) / 300)
    )
    cells = grid.cell_of(x, z)
    marked = mixing.sides(x, z, 0.31, 0.52)
    for group, share in zip(marked, mixing.side_shares(grid, 0.31, 0.52), strict=True):
        found = np.bincount(cells, group, 12) / np.bincount(cells, minlength=12)
        assert np.abs(found - share).max() < 0.02  # 90 x 70 points a cell


def test_remaining_shares_agree_with_loops():
    rng = np.random.default_rng(1)
    x, z = rng.random((2, 7, 300))
    found = mixing.remaining_from_positions(x, z, 0.4, 0.7)
    rules = [
        lambda f, p: x[f, p] < 0.4,
        lambda f, p: x[f, p] >= 0.4,
        lambda f, p: z[f, p] < 0.7,
        lambda f, p: z[f, p] >= 0.7,
    ]
    for g, inside in enumerate(rules):
        group = [p for p in range(300) if inside(0, p)]
        expected = [sum(bool(inside(f, p)) for p in group) / len(group) for f in range(7)]
        assert found[:, g].tolist() == pytest.approx(expected)
    grid = Grid(1.0, 1.0, 5, 10)
    marked = mixing.sides(x[0], z[0], 0.4, 0.7)
    from_cells = mixing.remaining_from_cells(grid.cell_of(x, z), marked, mixing.side_shares(grid, 0.4, 0.7))
    assert np.allclose(from_cells, found, atol=1e-12)  # both splits lie on edges
    cut = mixing.remaining_from_cells(grid.cell_of(x, z), marked, mixing.side_shares(grid, 0.5, 0.7))
    assert cut[0, 0] == 1.0 and cut[0, 1] < 1.0


def test_an_empty_group_is_not_a_number():
    found = mixing.remaining_from_positions(np.full((2, 3), 0.1), np.full((2, 3), 0.9), 0.5, 0.5)
    assert found[:, [0, 3]].tolist() == [[1, 1], [1, 1]] and np.isnan(found[:, [1, 2]]).all()


def test_histogram_counts_each_group():
    found = mixing.marked_histogram(
        np.array([2, 2, 0]), np.array([[True, True, False], [False, True, True]]), 4
    )
    assert found.tolist() == [[0, 0, 2, 0], [1, 0, 1, 0]] and found.dtype == np.int64


def test_histogram_leaves_out_who_is_not_there():
    counts = mixing.marked_histogram(np.array([2, -1, 0]), np.ones((1, 3), bool), 4)
    assert counts.tolist() == [[1, 0, 1, 0]]


def test_lacey_index_of_apart_mixed_and_drawn():
    assert mixing.lacey_index(np.array([10, 0, 0]), np.array([10, 10, 0])) == pytest.approx(0.0)
    # Perfectly even is above 1: dice would leave a spread of c (1 - c) / n.
    assert mixing.lacey_index(np.array([5, 5]), np.array([10, 10])) == pytest.approx(0.25 / (0.25 - 0.025))
    rng = np.random.default_rng(3)
    total = rng.integers(5, 60, 4000)
    assert mixing.lacey_index(rng.binomial(total, 0.3), total) == pytest.approx(1.0, abs=0.01)
    assert np.isnan(mixing.lacey_index(np.array([3, 3]), np.array([3, 3])))
