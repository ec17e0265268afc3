# SPDX-License-Identifier: GPL-3.0-or-later
"""The static chain's report of its matrix."""

import numpy as np
import pytest

from bedchain.chains.counting import count_moves
from bedchain.chains.estimators import ESTIMATORS, transition_matrix
from bedchain.chains.static import compare_estimators

ROUND_OFF = 1e-12


def paths(*particles: list[int]) -> np.ndarray:
    return np.array(particles, np.int32).T


def test_report_of_each_estimator():
    counts = count_moves(paths([0, 1, 0, 1], [0, 0, 0, 0], [1, 1, 2, 1]), 4)
    table = compare_estimators(counts)
    assert set(table) == set(ESTIMATORS)
    assert table["literal"]["leak_1"] > 0 and table["pooled"]["leak_1"] == 0
    assert table["literal"]["row_sum_error_1"] == pytest.approx(2 / 3)
    assert table["per_step"]["row_sum_error_1"] < ROUND_OFF
    assert all(abs(row["mass_1"] - 1) < ROUND_OFF for row in table.values())
    # at the starts cells 0, 1 and 2 hold 5, 3 and 1 of nine
    density = np.array([5, 3, 1, 0]) / 9
    for name, row in table.items():
        long_run = np.linalg.matrix_power(transition_matrix(counts, name).toarray(), 10_000)
        distance = 0.5 * np.abs(density @ long_run - density).sum()
        assert row["long_run_total_variation_1"] == pytest.approx(distance, abs=1e-9), name
