# SPDX-License-Identifier: GPL-3.0-or-later
"""Modes of matrices with known eigenvalues, and beside deeptime."""

import numpy as np
import pytest
from deeptime.markov.tools import analysis
from scipy import sparse

from bedchain.chains import modes
from bedchain.chains.modes import LEAST_HELD, mixing_time, slowest_modes, timescales_s
from made.matrices import random_matrix, reflecting_walk, ring, with_states_apart

SOLVER = 1e-9


def assert_eigenvectors(matrix, found):
    """Both eigenvectors belong to the eigenvalue."""
    assert np.abs(found.left.T @ matrix - found.eigenvalues[:, None] * found.left.T).max() < SOLVER
    assert np.abs(matrix @ found.right - found.right * found.eigenvalues).max() < SOLVER


def test_slowest_process_of_the_reflecting_walk():
    for matrix in (reflecting_walk(20), with_states_apart(reflecting_walk(20))):
        found = slowest_modes(matrix, 2)
        assert found.eigenvalues[0].real == pytest.approx(0.99384417, abs=5e-9)
        assert_eigenvectors(matrix, found)
        slowest = found.timescales_s(0.025)[0]
        assert mixing_time(slowest, 0.025) == pytest.approx(0.025 / (1 - 0.99384417), rel=1e-5)
        # a cosine over the row: the mean of its size squared over the mean of its square
        assert found.held[0] == pytest.approx(8 / np.pi**2, abs=0.002)
        assert found.density.sum() == pytest.approx(1) and found.density[3] == pytest.approx(1 / 20)


def test_a_ring_goes_round_and_decays():
    found = slowest_modes(ring(8, 0.75), 2)
    assert np.abs(found.eigenvalues) == pytest.approx(0.9434855817366555, abs=1e-12)
    value = 0.25 + 0.75 * np.exp(2j * np.pi / 8)
    assert found.periods_s(0.1) == pytest.approx(2 * np.pi * 0.1 / np.angle(value))
    assert np.isinf(slowest_modes(reflecting_walk(5), 1).periods_s(0.1)).all()
    assert mixing_time(slowest_modes(ring(8, 1.0), 1).timescales_s(1.0)[0], 1.0) == np.inf


def test_sparse_solver_agrees_with_the_dense_one(monkeypatch):
    # the ring of 14 states has pairs that the seventh power cannot tell apart
    for matrix in (random_matrix(2, 60), ring(14, 0.9)):
        dense = slowest_modes(matrix, 4)
        monkeypatch.setattr(modes, "DENSE_STATES", 2)
        found = slowest_modes(matrix, 4)
        monkeypatch.undo()
        assert np.abs(found.eigenvalues) == pytest.approx(np.abs(dense.eigenvalues), abs=SOLVER)
        assert found.held == pytest.approx(dense.held, abs=1e-6)
        assert_eigenvectors(matrix, found)


@pytest.mark.filterwarnings("ignore:Using eigenvalues with non-zero imaginary part")
def test_timescales_agree_with_deeptime():
    for seed in range(4):
        matrix = random_matrix(seed)
        theirs = analysis.timescales(matrix.toarray(), tau=2, k=5)
        assert slowest_modes(matrix, 4).timescales_s(2.0) == pytest.approx(theirs[1:], abs=SOLVER)


def test_a_process_of_a_few_cells_is_dropped():
    # two cells at the top hold little, and particles hardly leave them
    whole = np.zeros((22, 22))
    whole[:20, :20] = reflecting_walk(20, 0.2, 0.2).toarray()
    whole[20:, 20:] = [[0.4999, 0.5], [0.5, 0.5]]
    whole[20, 19], whole[19, 19], whole[19, 20] = 1e-4, whole[19, 19] - 1e-7, 1e-7
    found = slowest_modes(sparse.csr_array(whole), 3)
    assert found.dropped.size == 1 and abs(found.dropped[0]) > abs(found.eigenvalues[0])
    alone = slowest_modes(reflecting_walk(20, 0.2, 0.2), 3)
    assert np.abs(found.eigenvalues) == pytest.approx(np.abs(alone.eigenvalues), abs=1e-5)
    assert (found.held >= LEAST_HELD).all()


def test_a_leak_into_one_closed_cell_is_the_slowest_process():
    n, leak = 10, 1e-3
    whole = np.zeros((n + 1, n + 1))
    whole[:n, :n] = (1 - leak) * reflecting_walk(n).toarray()
    whole[:n, n], whole[n, n] = leak, 1
    found = slowest_modes(sparse.csr_array(whole), 2)
    assert found.timescales_s(1.0)[0] == pytest.approx(-1 / np.log1p(-leak))
    assert mixing_time(found.timescales_s(1.0)[0], 1.0) == pytest.approx(1 / leak)
    assert found.timescales_s(1.0)[1] == pytest.approx(
        timescales_s((1 - leak) * slowest_modes(reflecting_walk(n), 1).eigenvalues, 1.0)[0]
    )


def test_modes_again_are_those_of_the_changed_matrix():
    matrix, other = random_matrix(3, 40), random_matrix(4, 40)
    walk = sparse.csr_array(0.95 * reflecting_walk(40, 0.3, 0.2) + 0.05 * matrix)
    changed = sparse.csr_array(0.995 * walk + 0.005 * other)
    found = slowest_modes(walk, 4)
    again = found.again(changed, np.arange(40))
    exact = slowest_modes(changed, 4).eigenvalues
    assert np.abs(again[:2]) == pytest.approx(np.abs(exact[:2]), abs=1e-4)
    # without some states, and in another order
    assert np.abs(found.again(walk, np.arange(40))) == pytest.approx(np.abs(found.eigenvalues), abs=SOLVER)


def test_a_single_state_has_no_process():
    assert slowest_modes(sparse.csr_array(np.eye(3)), 2).eigenvalues.size == 0


def test_modes_again_at_a_long_lag():
    # few steps leave nothing but round-off of the fifth process
    walk, other = reflecting_walk(40, 0.3, 0.2), random_matrix(4, 40)
    long, changed = (
        sparse.csr_array(np.linalg.matrix_power(matrix.toarray(), 100))
        for matrix in (walk, 0.999 * walk + 0.001 * other)
    )
    again = slowest_modes(long, 5).again(changed, np.arange(40))
    exact = slowest_modes(changed, 5).eigenvalues
    assert np.abs(again) == pytest.approx(np.abs(exact), rel=0.02)
