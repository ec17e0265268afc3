# SPDX-License-Identifier: GPL-3.0-or-later
"""Painted particles: where they are, in their colour, as large as they are."""

import numpy as np
import pytest

from bedchain.figures.film import PIXELS_PER_DIAMETER, Canvas, in_their_cells, voidages
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid

DIAMETER = 1e-3
BLUE, RED, WHITE = [0, 0, 255], [255, 0, 0], [255, 255, 255]


@pytest.fixture
def canvas():
    return Canvas(0.02, 0.01, DIAMETER, ["#0000ff", "#ff0000"])


def test_discs_are_painted_where_they_are(canvas):
    picture = canvas.discs(np.array([0.005, 0.015]), np.array([0.0025, 0.0075]), np.array([True, False]))
    assert picture.shape == (10 * PIXELS_PER_DIAMETER, 20 * PIXELS_PER_DIAMETER, 3)
    at = lambda x, z: picture[int(z / canvas.pixel_m), int(x / canvas.pixel_m)].tolist()  # noqa: E731
    assert at(0.005, 0.0025) == BLUE and at(0.015, 0.0075) == RED and at(0.01, 0.005) == WHITE
    for colour in (BLUE, RED):
        # a disc of three pixels across is a square of them
        assert (picture == colour).all(axis=2).sum() == PIXELS_PER_DIAMETER**2 == 9


def test_particles_at_the_walls_are_cut_and_none_comes_out_on_the_other_side(canvas):
    picture = canvas.discs(np.array([0.0, 0.02]), np.array([0.0, 0.01]), np.array([True, True]))
    blue = np.argwhere((picture == BLUE).all(axis=2))
    rows, columns = picture.shape[:2]
    low = blue[(blue[:, 0] < 3) & (blue[:, 1] < 3)]
    high = blue[(blue[:, 0] > rows - 4) & (blue[:, 1] > columns - 4)]
    assert len(low) > 0 and len(low) + len(high) == len(blue)


def test_particles_of_a_chain_are_drawn_in_their_cells():
    grid = Grid(0.02, 0.04, 2, 4)
    cells = np.arange(8)
    shares = np.random.default_rng(1).random((2, 8))
    frames = [cells, cells[::-1]]
    places = list(in_their_cells(frames, grid, shares))
    assert [grid.cell_of(x, z).tolist() for x, z in places] == [frame.tolist() for frame in frames]
    # at the shares of each particle's cell
    assert places[0][0] == pytest.approx((cells % 2 + shares[0]) * 0.01)


def test_voidage_counts_the_particles_of_each_cell():
    x, z = np.array([[0.005, 0.005, 0.015]] * 3), np.array([[0.005, 0.006, 0.015]] * 3)
    frames = Frames(np.array([0.0, 1.0, 2.0]), x, z, np.zeros((3, 3), np.int32))
    pictures = list(voidages(frames, 2, 0.02, 0.02, 0.01, DIAMETER, DIAMETER))
    solids = np.pi / 6 * DIAMETER**3 / (0.01 * 0.01 * DIAMETER)
    assert len(pictures) == 2
    np.testing.assert_allclose(pictures[0], [[1 - 2 * solids, 1], [1, 1 - solids]])
