# SPDX-License-Identifier: GPL-3.0-or-later
"""Long-run density, eigenvalues, timescales and first passage of a transition matrix."""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph, linalg

from bedchain.chains.classes import closed_classes
from bedchain.errors import DataError

# Up to this many states a dense eigenvalue solver is faster, and certain to find all eigenvalues.
DENSE_STATES = 400
# Up to this many states linear systems are solved directly; above, the fill-in takes minutes and gigabytes.
DIRECT_STATES = 10_000
# Largest change of a long-run density in one step, summed over the states [1].
STATIONARY_TOLERANCE = 1e-9
# Iterative solution of a linear system: error relative to the right side, most iterations (the dynamic chain
# of 81 000 particles takes 13), and drop tolerance and fill factor of the incomplete factors. Cells are
# numbered row by row, so their natural order is best: 0.5 s; fill-reducing orders take 1 to 13 s.
ITERATION_ERROR, ITERATIONS = 1e-10, 1000
DROPPED, FILL, ORDER = 3e-2, 2, "NATURAL"
# Relative error of eigenvalues found by iteration; down to round-off takes twice as long.
EIGENVALUE_ERROR = 1e-10


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
    density[rest] = _solved(
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
        visits = _solved(sparse.csc_array(inside.T), start[transient])
        mass += np.where(recurrent, visits @ matrix[transient], 0.0)
    return mass


def leading_eigenvalues(matrix: sparse.csr_array, n: int = 6) -> NDArray[np.complex128]:
    """Eigenvalues of the largest closed class, by falling magnitude, the first is 1; (at most n,).

    The chain need not be reversible: particles circulate, and complex pairs of eigenvalues give the period.
    """
    states = closed_classes(matrix)[0]
    part = sparse.csr_array(matrix[states][:, states])
    if states.size <= max(DENSE_STATES, n + 2):
        eigenvalues = np.linalg.eigvals(part.toarray())
    else:
        start = np.random.default_rng(0).random(states.size)
        eigenvalues = linalg.eigs(
            part.T, k=n, which="LM", v0=start, ncv=max(5 * n, 20), tol=EIGENVALUE_ERROR,
            return_eigenvectors=False,
        )  # fmt: skip
    order = np.argsort(-np.abs(eigenvalues), kind="stable")
    return np.asarray(eigenvalues[order][:n], np.complex128)


def implied_timescales(matrix: sparse.csr_array, lag_s: float, n: int = 5) -> NDArray[np.float64]:
    """Relaxation times ``-lag / ln |lambda|`` of the slowest processes, slowest first, (at most n,) [s]."""
    size = np.abs(leading_eigenvalues(matrix, n + 1)[1:])
    inner = np.clip(size, np.finfo(float).tiny, 1.0)
    with np.errstate(divide="ignore"):
        return np.asarray(lag_s / np.abs(np.log(inner)))


def mixing_time(matrix: sparse.csr_array, lag_s: float) -> float:
    """Mixing time by the spectral gap, ``lag / (1 - |lambda_2|)`` [s]; infinite for a periodic chain."""
    size = np.abs(leading_eigenvalues(matrix, 2))
    if size.size < 2:
        return 0.0
    gap = 1.0 - float(size[1])
    return lag_s / gap if gap > np.finfo(float).eps * len(size) else float("inf")


def first_passage_steps(matrix: sparse.csr_array, target: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Mean number of steps until a set of states is first entered, from each state.

    Parameters
    ----------
    matrix : (n_states, n_states) csr_array
        Row-stochastic.
    target : (n_states,) bool array
        The set.

    Returns
    -------
    (n_states,) array
        0 in the set, infinite where a particle may never reach the set.
    """
    link = sparse.csr_array(matrix > 0)
    arrives = _leads_to(link, target, np.ones_like(target))
    strays = _leads_to(link, ~arrives, ~target)
    steps = np.where(target, 0.0, np.inf)
    inner = np.flatnonzero(~target & ~strays)
    if inner.size:
        system = sparse.csc_array(sparse.eye_array(inner.size) - matrix[inner][:, inner])
        steps[inner] = _solved(system, np.ones(inner.size))
    return steps


def _solved(system: sparse.csc_array, right: NDArray[np.float64]) -> NDArray[np.float64]:
    """Solution of a linear system, by elimination up to `DIRECT_STATES`, else by iteration."""
    if right.size > DIRECT_STATES:
        factors = linalg.spilu(system, drop_tol=DROPPED, fill_factor=FILL, permc_spec=ORDER)
        inverse = linalg.LinearOperator(system.shape, factors.solve)
        solution, failed = linalg.bicgstab(system, right, rtol=ITERATION_ERROR, maxiter=ITERATIONS, M=inverse)
        if not failed:
            return np.asarray(solution)
    return np.atleast_1d(linalg.spsolve(system, right))


def _leads_to(
    link: sparse.csr_array, target: NDArray[np.bool_], through: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """States from which a set can be reached along the given states, (n_states,)."""
    n = target.size
    rows, columns = link.nonzero()
    usable = through[rows]
    # Links backwards, and from one more state, number n, to all of the set.
    origin = np.concatenate((columns[usable], np.full(target.sum(), n)))
    end = np.concatenate((rows[usable], np.flatnonzero(target)))
    backwards = sparse.csr_array((np.ones(origin.size), (origin, end)), shape=(n + 1, n + 1))
    reached = np.zeros(n + 1, bool)
    reached[csgraph.breadth_first_order(backwards, n, return_predecessors=False)] = True
    return reached[:n]
