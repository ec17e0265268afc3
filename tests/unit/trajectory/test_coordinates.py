# SPDX-License-Identifier: GPL-3.0-or-later
"""Coordinates of cells: there and back, known places, and beds that are not round."""

import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.trajectory.coordinates import COORDINATES, Size, coordinates_of

SIZES = {"vertical": Size(0.2, 0.5, 0.2), "horizontal": Size(0.2, 0.2, 0.5)}


@pytest.mark.parametrize(("form", "axis"), COORDINATES)
def test_places_come_back_from_their_coordinates(form, axis):
    size, rng = SIZES[axis], np.random.default_rng(3)
    x, z, y = (length * rng.random(200) for length in size)
    values = COORDINATES[form, axis].of(x, z, y, size)
    again = COORDINATES[form, axis].place(*values, size)
    np.testing.assert_allclose(again, (x, z, y), atol=1e-12)
    for value, length in zip(values, COORDINATES[form, axis].lengths(size), strict=True):
        assert value.min() >= 0 and value.max() <= length * np.sqrt(2)


def test_the_arc_of_a_drum_goes_from_the_top_by_the_left_to_the_bottom():
    size = SIZES["horizontal"]
    x, z = np.array([[0.1, 0.0, 0.1, 0.2], [0.1999, 0.1, 0.0, 0.1]])
    arc, distance, _ = COORDINATES["sectors", "horizontal"].of(x - 1e-12, z, z, size)
    np.testing.assert_allclose(arc / (np.pi * 0.2), [0, 0.25, 0.5, 0.75], atol=1e-9)
    np.testing.assert_allclose(distance, [0.0999, 0.1, 0.1, 0.1], atol=1e-9)


def test_a_bed_that_is_not_round_and_an_unknown_form_are_refused():
    with pytest.raises(DataError, match=r"0.2 m wide and 0.1 m deep: it must be as deep as wide"):
        coordinates_of("rings", "vertical", Size(0.2, 0.5, 0.1))
    with pytest.raises(DataError, match=r"no cells of the form hexagons \(vertical\)"):
        coordinates_of("hexagons", "vertical", Size(0.2, 0.5, 0.1))
