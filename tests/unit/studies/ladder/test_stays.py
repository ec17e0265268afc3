# SPDX-License-Identifier: GPL-3.0-or-later
"""Stays in the lower part of made-up particles."""

import numpy as np
import pytest

from bedchain.studies.ladder.stays import stay_in_lower_part, stay_starts


def test_a_stay_ends_when_a_particle_is_first_out_and_at_the_horizon():
    # one leaves after a frame and comes back, one never leaves, one starts above the line
    heights = np.array([[0.5, 0.2, 2.0], [1.6, 0.2, 2.0], [0.5, 0.2, 0.1]])
    # shares 1, 1/2, 1/2 over two intervals of 0.1 s
    assert stay_in_lower_part(heights, 0.1, 1.0, 0.2) == pytest.approx(0.125)
    # a horizon between two frames
    assert stay_in_lower_part(heights, 0.1, 1.0, 0.15) == pytest.approx(0.1)
    assert np.isnan(stay_in_lower_part(heights[:, 2:], 0.1, 1.0, 0.2))


def test_starts_fill_both_windows_and_the_last_two_the_comparison():
    assert stay_starts(slice(0, 201), slice(200, 401)) == ([0, 100, 200, 300], 100)
    assert stay_starts(slice(60, 141), slice(140, 221))[0][-2:] == [140, 180]
