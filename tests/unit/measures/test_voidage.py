# SPDX-License-Identifier: GPL-3.0-or-later
"""Voidage of rows, by hand."""

import numpy as np

from bedchain.measures.voidage import Slab, voidage_profiles


def test_voidage_of_known_rows():
    z = np.array([[0.001, 0.002, 0.003, 0.015], [0.001, 0.015, 0.016, 0.017]])
    found = voidage_profiles(z, np.array([0, 0.01, 0.02]), 0.05, Slab(1e-3, 1e-3))
    one = np.pi / 6 * 1e-9 / (0.05 * 0.01 * 1e-3)
    np.testing.assert_allclose(found, [[1 - 3 * one, 1 - one], [1 - one, 1 - 3 * one]])
