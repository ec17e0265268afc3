# SPDX-License-Identifier: GPL-3.0-or-later
"""Long-run density of a transition matrix, and solution of its linear systems."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import linalg

from bedchain.chains.classes import closed_classes
from bedchain.errors import DataError

Solver = Callable[[NDArray[np.float64]], NDArray[np.float64]]

# Up to this many states linear systems are solved directly; above, the fill-in takes minutes and gigabytes.
DIRECT_STATES = 10_000
# Largest change of a long-run density in one step, summed over the states [1].
STATIONARY_TOLERANCE = 1e-9
# Iterative solution of a linear system: error relative to the right side, and most iterations, first scaled
# by the diagonal alone (100 for the dynamic chain of 81 000 particles, a third of the incomplete factors'
# time), then with incomplete factors: drop tolerance and fill factor. Cells are numbered row by row, so their
# natural order is best: 0.5 s; fill-reducing orders take 1 to 13 s.
ITERATION_ERROR, ITERATIONS, ITERATIONS_SCALED = 1e-10, 1000, 400
DROPPED, FILL, ORDER = 3e-2, 2, "NATURAL"


def long_run_density(matrix: sparse.csr_array, start: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distribution that the chain settles to from a start; of a periodic chain the mean over a period.

    Parameters
    ----------
    matrix : (n_states, n_states) csr_array
        Row-stochastic; several closed classes are allowed.
    start : (n_states,) array
        Distribution at the start [1].

    Returns
    -------
    (n_states,) array
        Stationary distribution of each closed class, weighted by the share of the start that ends up there.
    """
    classes = closed_classes(matrix)
    density = np.zeros(matrix.shape[0])
    absorbed = _absorbed(matrix, start / start.sum(), classes)
    for states in classes:
        share = absorbed[states].sum()
        if share > 0:
            density[states] = share * _stationary(sparse.csr_array(matrix[states][:, states]))
    return density


def _stationary(matrix: sparse.csr_array) -> NDArray[np.float64]:
    """Solution of ``p (I - P) = 0``, ``sum(p) = 1`` for one closed class."""
    n = matrix.shape[0]
    if n == 1:
        return np.ones(1)
    # The state with the largest inflow is set to 1, the others are solved for.
    first = int(np.argmax(matrix.sum(axis=0)))
    rest = np.flatnonzero(np.arange(n) != first)
    balance = sparse.csc_array((sparse.eye_array(n) - matrix).T)
    density = np.ones(n)
    density[rest] = solved(
        sparse.csc_array(balance[rest][:, rest]), -balance[rest][:, [first]].toarray().ravel()
    )
    density = np.abs(density) / np.abs(density).sum()
    change = float(np.abs(density @ matrix - density).sum())
    if change > STATIONARY_TOLERANCE:
        raise DataError(f"the long-run density did not converge: one step still changes {change:.2g} of it")
    return np.asarray(density)


def _absorbed(
    matrix: sparse.csr_array, start: NDArray[np.float64], classes: list[NDArray[np.int64]]
) -> NDArray[np.float64]:
    """Mass of the start by the recurrent state that it reaches first, (n_states,)."""
    recurrent = np.zeros(matrix.shape[0], bool)
    recurrent[np.concatenate(classes)] = True
    transient = np.flatnonzero(~recurrent)
    mass = np.where(recurrent, start, 0.0)
    if transient.size and start[transient].sum() > 0:
        inside = sparse.eye_array(transient.size) - matrix[transient][:, transient]
        visits = solved(sparse.csc_array(inside.T), start[transient])
        mass += np.where(recurrent, visits @ matrix[transient], 0.0)
    return mass


def solved(system: sparse.csc_array, right: NDArray[np.float64]) -> NDArray[np.float64]:
    """Solution of a linear system, by elimination up to `DIRECT_STATES`, else by iteration."""
    if right.size > DIRECT_STATES:
        solution = _iterated(system, right, _inverse_of_diagonal(system), ITERATIONS_SCALED)
        if solution is None:
            factors = linalg.spilu(system, drop_tol=DROPPED, fill_factor=FILL, permc_spec=ORDER)
            solution = _iterated(system, right, factors.solve, ITERATIONS)
        if solution is not None:
            return solution
    return np.atleast_1d(linalg.spsolve(system, right))


def _inverse_of_diagonal(system: sparse.csc_array) -> Solver:
    diagonal = system.diagonal()
    scale = 1 / np.where(diagonal == 0, 1.0, diagonal)
    return lambda vector: scale * vector


def _iterated(
    system: sparse.csc_array, right: NDArray[np.float64], solve: Solver, most: int
) -> NDArray[np.float64] | None:
    """Solution by BiCGSTAB with an approximate inverse; None where it does not converge."""
    inverse = linalg.LinearOperator(system.shape, matvec=solve, dtype=np.float64)
    rows = sparse.csr_array(system)  # products by rows are faster
    with np.errstate(all="ignore"):
        solution, failed = linalg.bicgstab(rows, right, rtol=ITERATION_ERROR, maxiter=most, M=inverse)
    return None if failed or not np.isfinite(solution).all() else np.asarray(solution)
