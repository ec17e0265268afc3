# SPDX-License-Identifier: GPL-3.0-or-later
"""Static mixer: its matrix by a plain loop, loadings, and cells that are too full."""

import numpy as np
import pytest

from bedchain.chains.networks.mixer import (
    check_filling,
    loaded,
    loading_variances,
    reflected_walk,
    static_mixer,
)
from bedchain.errors import DataError


def plain_step(contents, down, up, sideways):
    """One step of falling, row 0 at the top, moves one by one."""
    rows, columns = contents.shape
    later = np.zeros_like(contents)
    for (row, column), amount in np.ndenumerate(contents):
        for drop, fall in ((1, down), (-1, up), (0, 1 - down - up)):
            for shift, aside in ((1, sideways), (-1, sideways), (0, 1 - 2 * sideways)):
                low, side = row + drop, column + shift
                low = row if not 0 <= low < rows else low
                side = column if not 0 <= side < columns else side
                later[low, side] += fall * aside * amount
    return later


def test_a_revolution_is_falling_and_a_turn():
    mixer, start = static_mixer(4, 3, 2, 0.4, 0.1, 0.2), np.random.default_rng(1).random(12)
    now = start.reshape(4, 3)
    for _ in range(2):
        now = plain_step(now, 0.4, 0.1, 0.2)
    np.testing.assert_allclose(start @ mixer.product, now[::-1].ravel())
    assert len(mixer.cycle) == 2


def test_loadings_fill_half_of_the_cells_and_are_each_others_rest():
    for one, rest in (("top", "bottom"), ("left", "right"), ("bands", "between_bands")):
        np.testing.assert_allclose(loaded(8, 2, one, 0.4) + loaded(8, 2, rest, 0.4), 0.4)
    assert loaded(8, 1, "bands", 1.0).tolist() == [0, 1, 1, 0, 0, 1, 1, 0]


@pytest.mark.parametrize(("size", "where"), [((3, 1), "top"), ((4, 1), "left"), ((6, 1), "bands")])
def test_sizes_that_cannot_be_halved_are_refused(size, where):
    with pytest.raises(DataError, match=f"not loaded by {where}"):
        loaded(*size, where, 0.5)


def test_the_best_loading_is_0110_repeated():
    assert next(iter(loading_variances(8, 10, 0.25))) == "01100110"
    with pytest.raises(DataError, match="not tried"):
        loading_variances(18, 10, 0.25)


def test_an_overfull_cell_is_named_with_the_way_out():
    mixer = static_mixer(10, 1, 10, 0.35, 0.25, 0.0)
    contents = mixer.expected(loaded(10, 1, "top", 1.0), 60)
    assert contents.max() == pytest.approx(1.0603, abs=1e-4)
    with pytest.raises(DataError, match=r"holds 1.06 of its capacity of 1 at step .*at most 0.943"):
        check_filling(contents, mixer.names)
    check_filling(0.9 * contents, mixer.names)


def test_moves_beyond_1_are_refused():
    with pytest.raises(DataError, match="more than 1"):
        reflected_walk(3, 0.6, 0.5)
