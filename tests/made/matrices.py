# SPDX-License-Identifier: GPL-3.0-or-later
"""Transition matrices with known properties, shared by the tests of the chains."""

import numpy as np
from scipy import sparse


def reflecting_walk(n: int, up: float = 0.25, down: float = 0.25) -> sparse.csr_array:
    """Walk on a row of cells that reflects at both ends."""
    matrix = (
        np.diag(np.full(n, 1 - up - down))
        + np.diag(np.full(n - 1, up), 1)
        + np.diag(np.full(n - 1, down), -1)
    )
    matrix[0, 0] += down
    matrix[-1, -1] += up
    return sparse.csr_array(matrix)


def ring(n: int, p: float) -> sparse.csr_array:
    """Particles that go round a ring of cells, a cell a step with probability p."""
    return sparse.csr_array((1 - p) * np.eye(n) + p * np.roll(np.eye(n), 1, axis=1))


def random_matrix(seed: int, n: int = 25) -> sparse.csr_array:
    """Any matrix, far from reversible."""
    dense = np.random.default_rng(seed).random((n, n)) ** 4
    return sparse.csr_array(dense / dense.sum(axis=1, keepdims=True))


def with_states_apart(matrix: sparse.csr_array) -> sparse.csr_array:
    """The matrix with never-visited cells before, between and after its states."""
    n = matrix.shape[0]
    whole = np.eye(n + 3)
    keep = np.delete(np.arange(n + 3), [0, n // 2, n + 2])
    whole[np.ix_(keep, keep)] = matrix.toarray()
    return sparse.csr_array(whole)
