# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains on fewer states, exact where they can be, and their error by brute force."""

import numpy as np
import pytest

from bedchain.chains.coarse_graining import coarse_error, coarse_matrix
from bedchain.chains.matrix_analysis import long_run_density
from bedchain.errors import DataError
from made.matrices import random_matrix, reflecting_walk

GROUP = np.arange(25) % 4


def test_the_coarse_density_is_the_sum_of_the_fine_one():
    matrix = random_matrix(1)
    density = long_run_density(matrix, np.ones(25))
    coarse = coarse_matrix(matrix, density, GROUP)
    assert coarse.sum(axis=1) == pytest.approx(1)
    assert long_run_density(coarse, np.ones(4)) == pytest.approx(np.bincount(GROUP, density))


def test_states_that_move_alike_cost_nothing():
    # a walk on the shorter side of a rectangle, the other side lumped
    matrix = reflecting_walk(4)
    both = type(matrix)(np.kron(matrix.toarray(), reflecting_walk(3).toarray()))
    group = np.repeat(np.arange(4), 3)
    mean, largest = coarse_error(both, np.full(12, 1 / 12), group, 30)
    assert np.abs(coarse_matrix(both, np.full(12, 1 / 12), group) - matrix).max() < 1e-12
    assert largest.max() < 1e-12 and mean.max() < 1e-12


def test_error_is_that_of_powers_of_the_matrices():
    matrix = random_matrix(3)
    density = long_run_density(matrix, np.ones(25))
    mean, largest = coarse_error(matrix, density, GROUP, 4)
    coarse, onto = coarse_matrix(matrix, density, GROUP).toarray(), np.eye(4)[GROUP]
    for step in range(5):
        power, naive = np.linalg.matrix_power(matrix.toarray(), step), np.zeros(4)
        for start in range(4):
            held = np.where(start == GROUP, density, 0)
            exact = held / held.sum() @ power @ onto
            naive[start] = 0.5 * np.abs(exact - np.linalg.matrix_power(coarse, step)[start]).sum()
        assert largest[step] == pytest.approx(naive.max())
        assert mean[step] == pytest.approx(naive @ np.bincount(GROUP, density))
    assert largest[:2] == pytest.approx(0, abs=1e-12) and largest[2] > 1e-3


def test_empty_groups_stay_and_states_without_a_group_are_refused():
    density = np.where(GROUP == 2, 0.0, 1.0)
    assert coarse_matrix(random_matrix(2), density, GROUP)[2, 2] == 1
    with pytest.raises(DataError, match="give each state a number"):
        coarse_matrix(random_matrix(2), density, GROUP[:-1])
