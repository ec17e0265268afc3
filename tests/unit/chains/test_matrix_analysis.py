# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from deeptime.markov.tools import analysis
from scipy import sparse

from bedchain.chains import matrix_analysis
from bedchain.errors import DataError

SOLVER = 1e-9


def reflecting_walk(n: int, up: float = 0.25, down: float = 0.25) -> sparse.csr_array:
    matrix = (
        np.diag(np.full(n, 1 - up - down))
        + np.diag(np.full(n - 1, up), 1)
        + np.diag(np.full(n - 1, down), -1)
    )
    matrix[0, 0] += down
    matrix[-1, -1] += up
    return sparse.csr_array(matrix)


def ring(n: int, p: float) -> sparse.csr_array:
    return sparse.csr_array((1 - p) * np.eye(n) + p * np.roll(np.eye(n), 1, axis=1))


def random_matrix(seed: int, n: int = 25) -> sparse.csr_array:
    dense = np.random.default_rng(seed).random((n, n)) ** 4
    return sparse.csr_array(dense / dense.sum(axis=1, keepdims=True))


def with_states_apart(matrix: sparse.csr_array) -> sparse.csr_array:
    """The matrix with never-visited cells before, between and after its states."""
    n = matrix.shape[0]
    whole = np.eye(n + 3)
    keep = np.delete(np.arange(n + 3), [0, n // 2, n + 2])
    whole[np.ix_(keep, keep)] = matrix.toarray()
    return sparse.csr_array(whole)


def long_run_density(matrix: sparse.csr_array) -> np.ndarray:
    """Of a chain that reaches all states from each: the start does not matter."""
    return matrix_analysis.long_run_density(matrix, np.arange(matrix.shape[0]))


def test_second_eigenvalue_of_the_reflecting_walk():
    for matrix in (reflecting_walk(20), with_states_apart(reflecting_walk(20))):
        eigenvalues = matrix_analysis.leading_eigenvalues(matrix, 3)
        assert eigenvalues[0] == pytest.approx(1)
        assert eigenvalues[1].real == pytest.approx(0.99384417, abs=5e-9)
        assert matrix_analysis.implied_timescales(matrix, 0.025, 1)[0] == pytest.approx(
            -0.025 / np.log(eigenvalues[1].real)
        )
        assert matrix_analysis.mixing_time(matrix, 0.025) == pytest.approx(0.025 / (1 - 0.99384417), rel=1e-5)


def test_second_eigenvalue_of_the_ring_is_complex():
    eigenvalues = matrix_analysis.leading_eigenvalues(ring(8, 0.75), 3)
    assert abs(eigenvalues[1]) == pytest.approx(0.9434855817366555, abs=1e-12)
    assert abs(eigenvalues[1].imag) > 0.1 and abs(eigenvalues[2]) == pytest.approx(abs(eigenvalues[1]))
    assert matrix_analysis.mixing_time(ring(8, 1.0), 1.0) == np.inf


def test_sparse_solver_agrees_with_the_dense_one(monkeypatch):
    matrix = random_matrix(2, 60)
    dense = np.abs(matrix_analysis.leading_eigenvalues(matrix, 5))
    monkeypatch.setattr(matrix_analysis, "DENSE_STATES", 5)
    assert np.abs(matrix_analysis.leading_eigenvalues(matrix, 5)) == pytest.approx(dense, abs=SOLVER)


@pytest.mark.filterwarnings("ignore:Using eigenvalues with non-zero imaginary part")
def test_timescales_and_density_agree_with_deeptime():
    for seed in range(4):
        matrix = random_matrix(seed)
        ours, theirs = (
            matrix_analysis.implied_timescales(matrix, 2.0, 4),
            analysis.timescales(matrix.toarray(), tau=2, k=5),
        )
        assert ours == pytest.approx(theirs[1:], abs=SOLVER)
        density = long_run_density(matrix)
        assert np.abs(density - analysis.stationary_distribution(matrix.toarray())).max() < SOLVER


def test_density_by_iteration_agrees_with_the_direct_one(monkeypatch):
    for matrix in (random_matrix(5, 60), ring(60, 1.0), reflecting_walk(60, 0.3, 0.2)):
        direct = long_run_density(matrix)
        monkeypatch.setattr(matrix_analysis, "DIRECT_STATES", 5)
        assert np.abs(long_run_density(matrix) - direct).max() < 1e-7
        monkeypatch.undo()


def test_density_without_convergence_is_refused(monkeypatch):
    monkeypatch.setattr(matrix_analysis, "STATIONARY_TOLERANCE", 0.0)
    with pytest.raises(DataError, match="did not converge"):
        long_run_density(random_matrix(1))


def test_density_of_a_walk_with_drift_is_geometric():
    density = long_run_density(reflecting_walk(12, 0.2, 0.4))
    assert density[1:] / density[:-1] == pytest.approx(np.full(11, 0.5))


def test_long_run_density_weighs_closed_classes_by_what_they_catch():
    # 0 goes to 1 or to the pair 2-3, or stays; 4 is apart.
    matrix = np.zeros((5, 5))
    matrix[0, [0, 1, 2]] = 0.5, 0.2, 0.3
    matrix[1, 1] = matrix[2, 3] = matrix[3, 2] = matrix[4, 4] = 1
    start = np.array([2.0, 0, 0, 1, 1])
    density = matrix_analysis.long_run_density(sparse.csr_array(matrix), start)
    assert density == pytest.approx([0, 0.2, 0.275, 0.275, 0.25])


def test_first_passage_agrees_with_deeptime_and_by_hand():
    for seed in range(4):
        matrix = random_matrix(seed)
        target = np.zeros(25, bool)
        target[[3, 8]] = True
        theirs = analysis.mfpt(matrix.toarray(), [3, 8])
        ours = matrix_analysis.first_passage_steps(matrix, target)
        assert ours[~target] == pytest.approx(theirs[~target], rel=SOLVER) and (ours[target] == 0).all()
    up = matrix_analysis.first_passage_steps(reflecting_walk(5), np.arange(5) == 4)
    # From the wall, k cells up a walk of p = 1/4 each way: k (k + 1) / (2 p).
    assert up[0] == pytest.approx(4 * 5 * 2)


def test_first_passage_by_iteration_agrees_with_elimination(monkeypatch):
    matrix, target = random_matrix(5), np.arange(25) == 3
    direct = matrix_analysis.first_passage_steps(matrix, target)
    monkeypatch.setattr(matrix_analysis, "DIRECT_STATES", 1)
    assert matrix_analysis.first_passage_steps(matrix, target) == pytest.approx(direct, rel=1e-7)


def test_first_passage_is_infinite_where_the_target_may_be_missed():
    matrix = sparse.csr_array(np.array([[0.5, 0.25, 0.25, 0], [0, 1, 0, 0], [0, 0, 0, 1], [0, 0, 1, 0]]))
    assert matrix_analysis.first_passage_steps(matrix, np.arange(4) == 1).tolist() == [
        np.inf,
        0,
        np.inf,
        np.inf,
    ]
    assert matrix_analysis.first_passage_steps(matrix, np.arange(4) == 3).tolist() == [np.inf, np.inf, 1, 0]
