# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from deeptime.markov.tools import analysis
from scipy import sparse

from bedchain.chains import matrix_analysis
from bedchain.errors import DataError
from made.matrices import random_matrix, reflecting_walk, ring

SOLVER = 1e-9


def long_run_density(matrix: sparse.csr_array) -> np.ndarray:
    """Of a chain that reaches all states from each: the start does not matter."""
    return matrix_analysis.long_run_density(matrix, np.arange(matrix.shape[0]))


@pytest.mark.filterwarnings("ignore:Using eigenvalues with non-zero imaginary part")
def test_density_agrees_with_deeptime():
    for seed in range(4):
        matrix = random_matrix(seed)
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
