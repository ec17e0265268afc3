# SPDX-License-Identifier: GPL-3.0-or-later
"""Mixing curves: their errors by hand, their table and back."""

import numpy as np
import pandas as pd
import pytest

from bedchain.comparison.curves import curve_errors, curve_table, curves_of
from bedchain.errors import UserError
from bedchain.measures.mixing import GROUPS

DEM = np.array([[1.0, 1.0, 1.0, 1.0], [0.5, 0.6, 0.7, 0.8]])

MODEL = np.array([[1.0, 1.0, 1.0, 1.0], [0.7, 0.4, 0.7, 0.8]])


def test_errors_by_hand():
    errors = curve_errors(MODEL, DEM)
    # the start, where all curves are 1, does not count
    np.testing.assert_allclose(errors["error_signed"], [0.2, -0.2, 0, 0], atol=1e-15)
    np.testing.assert_allclose(errors["error_rms"], [0.2, 0.2, 0, 0], atol=1e-15)
    np.testing.assert_allclose(errors["crossed_end"], [0.3, 0.6, 0.3, 0.2])


def test_curves_in_long_form():
    table = curve_table(np.array([3.0, 3.025]), "dem", DEM)
    assert list(zip(table["direction"], table["group"], strict=True)) == [g for g in GROUPS for _ in range(2)]
    assert table["fraction_remaining_1"].tolist() == DEM.T.ravel().tolist()


TIMES = np.array([1.0, 1.5, 2.0])


def test_curves_come_back_from_the_table():
    curves = np.arange(12).reshape(3, 4) / 12
    table = pd.concat([curve_table(TIMES, "dem", 0 * curves), curve_table(TIMES, "dem_1", curves)])
    np.testing.assert_array_equal(curves_of(table, "dem_1", 3), curves)
    with pytest.raises(UserError, match="dem_2: 0 times, 3 expected"):
        curves_of(table, "dem_2", 3)
