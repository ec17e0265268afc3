# SPDX-License-Identifier: GPL-3.0-or-later
"""Observables of a chain: correlation in the long run, relaxation from a start, and independent samples."""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains.matrix_analysis import solved

Array = NDArray[np.float64]


def correlation(
    matrix: sparse.csr_array, density: Array, first: Array, second: Array | None, steps: int
) -> Array:
    """Covariance of two observables in the long run, the second so many steps after the first.

    Parameters
    ----------
    matrix : (n_states, n_states) csr_array
        Row-stochastic.
    density : (n_states,) array
        Long-run density [1].
    first, second : (n_states,) array
        Value of each observable in each state; the second is the first if None.
    steps : int

    Returns
    -------
    (steps + 1,) array
        ``sum_i density_i f_i (P^k g)_i - mean(f) mean(g)`` for k = 0 to ``steps``; over its first value the
        autocorrelation.
    """
    weights = density * (first - density @ first)
    now = np.asarray(first if second is None else second, float)
    now = now - density @ now
    values = np.empty(steps + 1)
    for step in range(steps + 1):
        now = matrix @ now if step else now
        values[step] = weights @ now
    return values


def relaxation(matrix: sparse.csr_array, start: Array, observable: Array, steps: int) -> Array:
    """Expected mean of an observable at steps 0 to ``steps`` after a start, (steps + 1,).

    Parameters
    ----------
    matrix : (n_states, n_states) csr_array
        Row-stochastic.
    start : (n_states,) array
        Distribution at step 0, sum 1 [1].
    observable : (n_states,) array
    steps : int
    """
    back, now = sparse.csr_array(matrix.T), np.asarray(start, float)
    values = np.empty(steps + 1)
    for step in range(steps + 1):
        now = back @ now if step else now
        values[step] = now @ observable
    return values


def correlation_time(matrix: sparse.csr_array, density: Array, observable: Array) -> float:
    """Integrated autocorrelation time ``1 + 2 sum(rho_k)`` of one particle's observable, exactly [steps].

    The sum of all covariances is ``<f, x>`` with ``(I - P) x = f - mean(f)`` and mean 0 of x.

    Parameters
    ----------
    matrix : (n_states, n_states) csr_array
        Row-stochastic; every state with a density reaches every other.
    density : (n_states,) array
        Long-run density [1].
    observable : (n_states,) array

    Returns
    -------
    float
        NaN for an observable that does not vary.
    """
    held = np.flatnonzero(density > 0)
    weights, value = density[held] / density[held].sum(), observable[held] - density[held] @ observable[held]
    variance = float(weights @ value**2)
    if held.size < 2 or variance == 0:
        return float("nan")
    system = sparse.csr_array(sparse.eye_array(held.size) - matrix[held][:, held])
    rest = np.arange(held.size) != np.argmax(weights)
    # the solution is known up to a constant: 0 in one state, then the mean is taken off
    solution = np.zeros(held.size)
    solution[rest] = solved(sparse.csc_array(system[rest][:, rest]), value[rest])
    total = float(weights @ (value * (solution - weights @ solution)))
    return 2 * total / variance - 1


def effective_samples(matrix: sparse.csr_array, density: Array, observable: Array, steps: int) -> float:
    """Independent samples that know the mean of an observable as well as a particle followed so long."""
    return steps / correlation_time(matrix, density, observable)
