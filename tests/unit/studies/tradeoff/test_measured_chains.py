# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments at which chains are measured."""

import numpy as np

from bedchain.studies.tradeoff.measured_chains import MOMENTS, half_moments


def test_halves_of_a_window_have_rising_moments_inside():
    for length in (2, 3, 80, 81):
        first, second = half_moments(length)
        assert len(first) == len(second) == MOMENTS
        assert first[0] >= 1 and first[-1] <= second[0] and second[-1] == length
        assert (np.diff(first) >= 0).all() and (np.diff(second) >= 0).all()
