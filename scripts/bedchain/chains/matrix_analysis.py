# SPDX-License-Identifier: GPL-3.0-or-later
"""What a transition matrix implies: long-run density, timescales, passage and residence times."""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import linalg

from bedchain.chains.classes import closed_classes
from bedchain.errors import DataError

# Up to this many states a dense eigenvalue solver is faster, and sure to find all.
DENSE_STATES = 400
# Up to this many states linear systems are solved directly; the fill-in of more takes minutes and gigabytes.
DIRECT_STATES = 10_000
# What one step may change of a long-run density found by iteration.
STATIONARY_TOLERANCE = 1e-9
# A linear system solved by iteration: error relative to its right side, iterations at most (the dynamic chain
# of 81 000 particles takes 13), and what its incomplete factors leave out and may fill. Cells are numbered
# row by row, so that the order as it is serves best: half a second, a fill-reducing one takes 1 to 13.
ITERATION_ERROR, ITERATIONS = 1e-10, 1000
DROPPED, FILL, ORDER = 3e-2, 2, "NATURAL"
# Error of eigenvalues found by iteration, relative to themselves; round-off takes twice as long.
EIGENVALUE_ERROR = 1e-10


def long_run_density(matrix: sparse.csr_array, start: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distribution that the chain settles to from a start, averaged over a period if it has one.

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


def stationary_density(matrix: sparse.csr_array) -> NDArray[np.float64]:
    """Stationary distribution of the largest closed class, 0 elsewhere, (n_states,)."""
    states = closed_classes(matrix)[0]
    density = np.zeros(matrix.shape[0])
    density[states] = _stationary(sparse.csr_array(matrix[states][:, states]))
    return density


def _stationary(matrix: sparse.csr_array) -> NDArray[np.float64]:
    """Solution of ``p (I - P) = 0``, ``sum(p) = 1`` for one closed class."""
    n = matrix.shape[0]
    if n == 1:
        return np.ones(1)
    # The most entered state is set to 1, the rest solved for.
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
    """Mass of the start in each recurrent state when it first gets to one."""
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

    No reversibility is assumed: particles go round, and pairs of complex eigenvalues tell how fast.
    """
    states = closed_classes(matrix)[0]
    part = sparse.csr_array(matrix[states][:, states])
    if states.size <= max(DENSE_STATES, n + 2):
        found = np.linalg.eigvals(part.toarray())
    else:
        start = np.random.default_rng(0).random(states.size)
        found = linalg.eigs(
            part.T, k=n, which="LM", v0=start, ncv=max(5 * n, 20), tol=EIGENVALUE_ERROR,
            return_eigenvectors=False,
        )  # fmt: skip
    return np.asarray(found[np.argsort(-np.abs(found), kind="stable")][:n], np.complex128)


def implied_timescales(matrix: sparse.csr_array, lag_s: float, n: int = 5) -> NDArray[np.float64]:
    """Relaxation times ``-lag / ln |lambda|`` of the slowest processes, slowest first, (at most n,) [s]."""
    size = np.abs(leading_eigenvalues(matrix, n + 1)[1:])
    inner = np.clip(size, np.finfo(float).tiny, 1.0)
    with np.errstate(divide="ignore"):
        return np.asarray(lag_s / np.abs(np.log(inner)))


def mixing_time(matrix: sparse.csr_array, lag_s: float) -> float:
    """Mixing time by the spectral gap, ``lag / (1 - |lambda_2|)`` [s]; infinite for a chain with a period."""
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
        0 in the set, infinite where the set may never be reached.
    """
    link = sparse.csr_array(matrix > 0).astype(np.int8)
    arrives = _leads_to(link, target, np.ones_like(target))
    strays = _leads_to(link, ~arrives, ~target)
    steps = np.where(target, 0.0, np.inf)
    inner = np.flatnonzero(~target & ~strays)
    if inner.size:
        system = sparse.csc_array(sparse.eye_array(inner.size) - matrix[inner][:, inner])
        steps[inner] = _solved(system, np.ones(inner.size))
    return steps


def _solved(system: sparse.csc_array, right: NDArray[np.float64]) -> NDArray[np.float64]:
    """Solution of a linear system: by elimination, or by iteration where its fill would take minutes."""
    if right.size > DIRECT_STATES:
        nearly = linalg.spilu(system, drop_tol=DROPPED, fill_factor=FILL, permc_spec=ORDER)
        guide = linalg.LinearOperator(system.shape, nearly.solve)
        found, failed = linalg.bicgstab(system, right, rtol=ITERATION_ERROR, maxiter=ITERATIONS, M=guide)
        if not failed:
            return np.asarray(found)
    return np.atleast_1d(linalg.spsolve(system, right))


def _leads_to(
    link: sparse.csr_array, there: NDArray[np.bool_], through: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """States from which a set may be reached through the given states."""
    reached = there.copy()
    while True:
        more = reached | (through & (link.astype(np.int32) @ reached.astype(np.int32) > 0))
        if (more == reached).all():
            return reached
        reached = more


def residence_steps(matrix: sparse.csr_array) -> NDArray[np.float64]:
    """Mean number of steps that a particle stays in each state, ``1 / (1 - P_ii)``, (n_states,)."""
    leave = 1.0 - matrix.diagonal()
    return np.divide(1.0, leave, out=np.full(leave.shape, np.inf), where=leave > 0)
