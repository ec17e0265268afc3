# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells by rule: the largest that add little, and data that allow no choice."""

import numpy as np
import pytest

from bedchain.measures.choice_of_cells import MOST_ADDED, choose_cells, counts_of
from made.frames import kept_velocity

BOX_M, SPEED_M_S, WALKERS, FRAMES, DIAMETER_M = 0.5, 0.2, 500, 201, 1e-3


def cells_of_walkers(lag, lines=(0.25, 0.25)):
    frames = kept_velocity(WALKERS, FRAMES, BOX_M, 0.1, SPEED_M_S, 4)
    return choose_cells((frames.x_m, frames.z_m), (BOX_M, BOX_M), lines, DIAMETER_M, lag)


def test_cells_are_the_largest_that_add_little():
    cells = cells_of_walkers(20)
    side = BOX_M / cells.columns
    fine = [largest for largest, x, z in cells.tried if max(x, z) < MOST_ADDED]
    assert cells.columns == cells.rows and side == pytest.approx(max(fine)) and not cells.doubt
    assert max(cells.added) < MOST_ADDED < max(shares for size, *shares in cells.tried if size > side)[0]


def test_a_longer_lag_takes_larger_cells():
    assert cells_of_walkers(4).columns > cells_of_walkers(40).columns


def test_cells_that_add_too_much_whatever_their_size_are_doubted():
    rng = np.random.default_rng(2)
    places = 0.05 + np.cumsum(rng.normal(0, 1e-4, (40, 50)), axis=0)
    cells = choose_cells((places, places), (0.1, 0.1), (0.05, 0.05), DIAMETER_M, 1)
    assert cells.columns == 100 and "even the smallest cells" in cells.doubt


def test_sides_are_whole_halves_of_a_diameter_and_below_the_line():
    counts = counts_of(0.4, 0.08, DIAMETER_M)
    assert counts[0] == 5 and counts[-1] == 400 and all(800 % count == 0 for count in counts)
    assert counts_of(0.3333, 0.1, DIAMETER_M)[:2] == [4, 5]
    assert counts_of(0.002, 0.001, DIAMETER_M) == [2]
