# SPDX-License-Identifier: GPL-3.0-or-later
"""Bands hold the truth as often as they say: the study of the bands in small."""

import numpy as np
import pytest

from bedchain.measures.mixing import Splits
from bedchain.studies.coverage import ar1_rows, bed_rows, gust_rows, walk_rows
from made.frames import stirred

# a share of 0.95 of 1000 is known to 0.007: three of it
CHANCE = 0.021


@pytest.mark.parametrize("rows", [ar1_rows, gust_rows])
def test_bands_hold_from_ten_correlation_times_on(rows):
    short, *longer = rows((3, 10, 40), 1000, np.random.default_rng(3))
    # this is why a band says that a window is too short
    assert short.covered_1 < 0.87
    assert [row.covered_1 for row in longer] >= [0.90 - CHANCE, 0.93 - CHANCE]
    assert all(row.covered_1 < 0.95 + CHANCE for row in longer)
    assert [row.correlation_times_1 for row in longer] == [10, 40]


def test_bands_of_chains_hold():
    (row,) = walk_rows((10,), 6, 3)
    assert row.samples_1 == 72 and row.covered_1 > 0.75


def test_windows_of_a_bed_are_judged_by_the_rest_of_it():
    frames, grid = stirred(3, n_frames=121)
    rows = list(bed_rows("stirred", frames, grid, Splits(0.025, 0.04), (1, 500), ("static",)))
    # there are no two windows of 500 correlation times
    (row,) = rows
    assert row.correlation_times_1 == pytest.approx(1, rel=0.2) and row.windows_1 >= 2
    assert row.samples_1 % 16 == 0 and 0.3 < row.covered_1 <= 1
