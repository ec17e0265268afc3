# SPDX-License-Identifier: GPL-3.0-or-later
"""What figures share."""

import numpy as np
import pytest

from bedchain.figures.style import shown_height
from bedchain.trajectory.grid import Grid

GRID = Grid(0.02, 0.03, 2, 3)


def test_shown_height_is_whole_rows_within_the_bed():
    assert shown_height(np.array([0, 1]), GRID) == pytest.approx(0.02)
    assert shown_height(np.array([5]), GRID) == pytest.approx(0.03)
