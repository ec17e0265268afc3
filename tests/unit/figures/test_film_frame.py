# SPDX-License-Identifier: GPL-3.0-or-later
"""Frame of a film: what is painted where, and a clock that changes."""

import numpy as np
import pytest

from bedchain.figures.film import Canvas
from bedchain.figures.film_frame import FilmFrame
from bedchain.figures.style import figure_style

GREEN = [0, 128, 0]


def frame_of(width_m, height_m, names):
    canvas = Canvas(width_m, height_m, 1e-3, 2e-4, ["#0000ff", "#ff0000"])
    with figure_style():
        frame = FilmFrame(names, canvas)
        frame.colour_bar(1, "Blues_r", (0.35, 1.0))
        frame.legend(0, [("left", "#0000ff"), ("right", "#ff0000")])
        frame.draw()
    return canvas, frame


@pytest.fixture(scope="module")
def drawn():
    """A canvas, and a frame of three panels."""
    return frame_of(0.03, 0.1, ["DEM", "voidage", "static chain"])


def test_a_picture_fills_its_panel_and_nothing_else(drawn):
    canvas, frame = drawn
    frame.draw()
    before = frame.image.copy()
    picture = np.zeros((*canvas.shape, 3), np.uint8)
    picture[:] = GREEN
    picture[0] = 7
    frame.paint(1, picture)
    changed = (frame.image != before).any(axis=2)
    rows, columns = np.nonzero(changed)
    assert (np.ptp(rows) + 1, np.ptp(columns) + 1) == canvas.shape and changed.sum() == canvas.shape[
        0
    ] * canvas.shape[1]
    # the lowest row of the bed is the lowest of the image
    assert (frame.image[rows.max(), columns.min()] == 7).all()
    assert frame.image[rows.min(), columns.min()].tolist() == GREEN


def test_the_walls_of_the_bed_are_beside_its_picture(drawn):
    canvas, frame = drawn
    frame.draw()
    for rows, columns in frame.panels:
        # the outer half of the wall's line, which no picture hides
        for wall in (frame.image[rows, columns.start - 1], frame.image[rows, columns.stop]):
            assert (wall.mean(axis=1) < 250).mean() > 0.9


def test_the_clock_shows_the_time_and_leaves_the_panels_alone(drawn):
    _, frame = drawn
    frame.draw()
    images = []
    for time_s in (15.0, 15.025, 15.0):
        frame.show_time(time_s)
        images.append(frame.image.copy())
    assert np.array_equal(images[0], images[2])
    rows, _ = np.nonzero((images[0] != images[1]).any(axis=2))
    # digits of a fifth of an inch where a panel is 5.6 inches high, above the panels' names
    assert 0.1 < np.ptp(rows) / frame.dpi < 0.25
    assert rows.max() < frame.panels[0][0].start - 0.3 * frame.dpi


@pytest.mark.parametrize("width_m", [0.004, 0.3])
def test_frames_of_narrow_and_wide_beds_have_even_sizes_and_room_for_every_panel(width_m):
    canvas, frame = frame_of(width_m, 0.1, ["DEM", "voidage of the DEM", "static chain", "dynamic chain"])
    assert frame.image.shape[0] % 2 == frame.image.shape[1] % 2 == 0
    ends = [(columns.start, columns.stop) for _, columns in frame.panels]
    assert all(stop - first == canvas.shape[1] for first, stop in ends)
    assert all(stop < first for (_, stop), (first, _) in zip(ends, ends[1:], strict=False))
    assert ends[-1][1] < frame.image.shape[1]
