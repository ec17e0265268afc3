# SPDX-License-Identifier: GPL-3.0-or-later
"""Bands from blocks left out in turn: the error of a mean."""

import numpy as np

from bedchain.uncertainty.left_out import left_out_band


def test_the_band_of_a_mean_is_that_of_its_blocks():
    blocks = np.array([1.0, 2.0, 3.0, 4.0, 6.0])
    left_out = np.array([np.delete(blocks, at).mean() for at in range(5)])
    low, high = left_out_band(blocks.mean(), left_out)
    half = 2.7764451 * blocks.std(ddof=1) / np.sqrt(5)
    np.testing.assert_allclose([low, high], [3.2 - half, 3.2 + half], rtol=1e-6)
