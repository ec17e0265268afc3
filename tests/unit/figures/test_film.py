# SPDX-License-Identifier: GPL-3.0-or-later
"""Painted particles and cells: where they are, in their colour, as large as they are."""

import numpy as np
import pytest
from matplotlib import colormaps

from bedchain.figures.film import (
    MOST_COLUMNS,
    MOST_PIXELS_PER_DIAMETER,
    MOST_ROWS,
    Canvas,
    at_film_steps,
    in_their_cells,
    pixel_size,
    voidages,
)
from bedchain.measures.voidage import Slab
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.packed_positions import middle_of

DIAMETER = 1e-3
BLUE, RED, WHITE = [0, 0, 255], [255, 0, 0], [255, 255, 255]


def canvas(pixels):
    return Canvas(0.02, 0.01, DIAMETER, DIAMETER / pixels, ["#0000ff", "#ff0000"])


# a disc of two or three pixels across is a square of them, one of four lacks the corners
@pytest.mark.parametrize(("pixels", "area"), [(1, 4), (2, 4), (3, 9), (4, 12)])
def test_discs_are_painted_where_they_are(pixels, area):
    bed = canvas(pixels)
    picture = bed.discs(np.array([0.005, 0.015]), np.array([0.0025, 0.0075]), np.array([True, False]))
    assert picture.shape == (10 * pixels, 20 * pixels, 3)
    for colour, place in ((BLUE, (0.005, 0.0025)), (RED, (0.015, 0.0075))):
        row, column = np.nonzero((picture == colour).all(axis=2))
        assert len(row) == area
        centre = (column.mean() + 0.5) * bed.pixel_m, (row.mean() + 0.5) * bed.pixel_m
        assert centre == pytest.approx(place, abs=0.51 * bed.pixel_m)
    assert (picture == WHITE).all(axis=2).sum() == 200 * pixels**2 - 2 * area


@pytest.mark.parametrize("pixels", [1, 3, 4])
def test_particles_at_the_walls_are_cut_and_none_comes_out_on_the_other_side(pixels):
    far = np.array([0.0, 0.02, 0.01, 0.01, -0.003, 0.023, 0.01])
    picture = canvas(pixels).discs(far, np.array([0.0, 0.01, -0.003, 0.013, 0.005, 0.005, 1.0]), far > -1)
    blue = np.argwhere((picture == BLUE).all(axis=2))
    rows, columns = picture.shape[:2]
    low = blue[(blue < 3).all(axis=1)]
    high = blue[(blue > np.array([rows, columns]) - 4).all(axis=1)]
    assert len(low) > 0 and len(low) + len(high) == len(blue)


def test_a_cell_is_painted_in_its_colour_over_all_its_pixels():
    grid = Grid(0.02, 0.02, 4, 4)  # twice as high as the picture
    values = np.linspace(-1, 2, 16)
    picture = canvas(2).cells(values, grid, (0.0, 1.0), "Blues_r")
    expected = 255 * colormaps["Blues_r"](np.clip(values[:8], 0, 1))[:, :3].reshape(2, 4, 3)
    np.testing.assert_allclose(picture, expected.repeat(10, axis=0).repeat(10, axis=1), atol=2)


def test_the_picture_of_a_bed_fits_the_film():
    assert pixel_size(0.1, 0.2, DIAMETER, 3) == DIAMETER / MOST_PIXELS_PER_DIAMETER
    assert pixel_size(0.1, 2.0, DIAMETER, 3) == 2.0 / MOST_ROWS
    assert 4 * 9.0 / pixel_size(9.0, 2.0, DIAMETER, 4) == pytest.approx(MOST_COLUMNS)


def test_particles_of_a_chain_are_drawn_in_their_cells():
    grid = Grid(0.02, 0.04, 2, 4)
    cells = np.arange(8)
    shares = np.random.default_rng(1).random((2, 8))
    frames = [cells, cells[::-1]]
    places = list(in_their_cells(frames, grid, shares))
    assert [grid.cell_of(x, z).tolist() for x, z in places] == [frame.tolist() for frame in frames]
    # at the shares of each particle's cell
    assert places[0][0] == pytest.approx((cells % 2 + shares[0]) * 0.01)


# steps of the chain that frames 0, 1, 2, ... of the film show
@pytest.mark.parametrize(
    ("lag", "film_lag", "shown"), [(2, 2, [0, 1, 2, 3]), (5, 2, [0, 0, 0, 1, 1, 2]), (1, 2, [0, 2, 4])]
)
def test_each_frame_shows_the_newest_step_of_a_chain(lag, film_lag, shown):
    steps = ((np.array([step]), np.array([-step])) for step in range((len(shown) - 1) * film_lag // lag + 1))
    places = list(at_film_steps(steps, lag, film_lag, len(shown)))
    assert [int(x[0]) for x, _ in places] == shown
    assert [int(z[0]) for _, z in places] == [-step for step in shown]


def test_voidage_counts_the_particles_of_each_cell():
    x, z = np.array([[0.005, 0.005, 0.015]] * 3), np.array([[0.005, 0.006, 0.015]] * 3)
    frames = Frames(np.array([0.0, 1.0, 2.0]), x, z, np.zeros((3, 3), np.int32))
    pictures = list(voidages(frames, 2, Grid(0.02, 0.02, 2, 2), Slab(DIAMETER, DIAMETER)))
    solids = np.pi / 6 * DIAMETER**3 / (0.01 * 0.01 * DIAMETER)
    assert len(pictures) == 2
    np.testing.assert_allclose(pictures[0], [1 - 2 * solids, 1, 1, 1 - solids])


def test_positions_kept_in_levels_leave_no_line_in_the_voidage():
    # an archive's levels of 0.5 mm: rows of 4.990 mm would hold 9 of them here and there, 10 elsewhere
    heights = middle_of(np.arange(2100, dtype=np.uint16), 0.5e-3)
    frames = Frames(np.zeros(1), np.full((1, 2100), 0.1), heights[None], np.zeros((1, 2100), np.int32))
    (picture,) = voidages(frames, 1, Grid(0.27, 1.05, 54, 210), Slab(DIAMETER, DIAMETER))
    column = picture.reshape(210, 54)[:, 20]
    assert column[0] < 1 and np.ptp(column) == 0
