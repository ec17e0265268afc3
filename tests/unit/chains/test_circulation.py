# SPDX-License-Identifier: GPL-3.0-or-later
"""Circulation of chains with known fluxes."""

import numpy as np
import pytest
from scipy import sparse

from bedchain.chains.circulation import circulation
from bedchain.chains.markov_chain import MarkovChain
from bedchain.trajectory.grid import Grid
from made.matrices import random_matrix, reflecting_walk

LAG_S = 0.5


def of_cells(matrix, grid):
    """Chain whose states are the cells."""
    cells = np.arange(grid.n_cells, dtype=np.int32)
    return MarkovChain("static", grid, 1, LAG_S, sparse.csr_array(matrix), cells, 1, np.zeros(0, np.int64), 0)


def test_a_walk_with_drift_between_walls_is_in_detailed_balance():
    matrix = reflecting_walk(6, 0.3, 0.2)
    density = 1.5 ** np.arange(6)
    result = circulation(of_cells(matrix, Grid(0.1, 0.6, 1, 6)), density / density.sum())
    assert np.abs(result.flow_m_s).max() < 1e-15 and np.abs(result.entropy_1_s).max() < 1e-15
    assert result.net_share < 1e-12 and result.one_way_share == 0


def test_four_cells_that_particles_go_round():
    # cells 0 1 / 2 3: round by 0 -> 1 -> 3 -> 2 -> 0
    forth, back, matrix = 0.4, 0.1, np.zeros((4, 4))
    for here, there in ((0, 1), (1, 3), (3, 2), (2, 0)):
        matrix[here, there], matrix[there, here] = forth, back
    matrix += np.diag(1 - matrix.sum(axis=1))
    result = circulation(of_cells(matrix, Grid(0.2, 0.2, 2, 2)), np.full(4, 0.25))
    net = 0.25 * (forth - back) / LAG_S
    # half of what comes in, along one axis, and half of what goes out, along the other
    assert result.flow_m_s[0] == pytest.approx([0.5 * net * 0.1, -0.5 * net * 0.1])
    assert result.flow_m_s[3] == pytest.approx([-0.5 * net * 0.1, 0.5 * net * 0.1])
    assert result.net_share == pytest.approx((forth - back) / (forth + back))
    assert result.entropy_1_s == pytest.approx(net * np.log(forth / back))
    one_way = np.where(matrix == back, 0, matrix) + back * np.eye(4)
    result = circulation(of_cells(one_way, Grid(0.2, 0.2, 2, 2)), np.full(4, 0.25))
    assert (result.net_share, result.one_way_share) == pytest.approx((1, 1)) and not result.entropy_1_s.any()


def test_entropy_of_any_matrix_is_that_of_the_double_sum():
    grid, matrix = Grid(0.5, 0.5, 5, 5), random_matrix(3)
    density = np.linalg.matrix_power(matrix.toarray(), 2000)[0]
    result, total, net, moved = circulation(of_cells(matrix, grid), density), 0.0, 0.0, 0.0
    for i in range(25):
        for j in range(25):
            there, here = density[i] * matrix[i, j], density[j] * matrix[j, i]
            total += 0.5 * (there - here) * np.log(there / here)
            net, moved = net + max(there - here, 0), moved + there * (i != j)
    assert result.entropy_1_s.sum() == pytest.approx(total / LAG_S)
    assert result.net_share == pytest.approx(net / moved)
    assert result.density == pytest.approx(density)
