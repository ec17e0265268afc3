# SPDX-License-Identifier: GPL-3.0-or-later
"""First passage to sets of states: means, variances, distributions, and which of two sets is reached first.

Residence times are first passages too: out of a set, from where particles enter it (`entry_distribution`).
"""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from bedchain.chains.matrix_analysis import solved

Array = NDArray[np.float64]
Set = NDArray[np.bool_]


def first_passage_steps(matrix: sparse.csr_array, target: Set) -> Array:
    """Mean number of steps until a set of states is first entered, from each state; see `passage_moments`."""
    return _mean_and_system(matrix, target)[0]


def passage_moments(matrix: sparse.csr_array, target: Set) -> tuple[Array, Array]:
    """Mean and variance of the number of steps until a set of states is first entered, from each state.

    With Q the matrix without the set, ``(I - Q) m1 = 1`` and ``(I - Q) m2 = 2 m1 - 1`` (Kemeny and Snell,
    Finite Markov Chains, 1960, 3.3).

    Parameters
    ----------
    matrix : (n_states, n_states) csr_array
        Row-stochastic.
    target : (n_states,) bool array
        The set.

    Returns
    -------
    mean, variance : (n_states,) array
        0 in the set, infinite where a particle may never reach the set [1].
    """
    mean, inner, system = _mean_and_system(matrix, target)
    variance = mean.copy()
    if inner.size:
        second = solved(system, 2 * mean[inner] - 1)
        variance[inner] = np.maximum(second - mean[inner] ** 2, 0.0)
    return mean, variance


def _mean_and_system(
    matrix: sparse.csr_array, target: Set
) -> tuple[Array, NDArray[np.int64], sparse.csc_array]:
    """Mean passage steps, the states outside the set that surely reach it, and ``I - Q`` of them."""
    link = sparse.csr_array(matrix > 0)
    arrives = _leads_to(link, target, np.ones_like(target))
    strays = _leads_to(link, ~arrives, ~target)
    mean, inner = np.where(target, 0.0, np.inf), np.flatnonzero(~target & ~strays)
    system = sparse.csc_array(sparse.eye_array(inner.size) - matrix[inner][:, inner])
    if inner.size:
        mean[inner] = solved(system, np.ones(inner.size))
    return mean, inner, system


def passage_distribution(matrix: sparse.csr_array, target: Set, start: Array, steps: int) -> Array:
    """Share of the particles that first enter a set at steps 0 to ``steps``.

    Parameters
    ----------
    matrix : (n_states, n_states) csr_array
        Row-stochastic.
    target : (n_states,) bool array
        The set.
    start : (n_states,) array
        Distribution at step 0, sum 1 [1].
    steps : int

    Returns
    -------
    (steps + 1,) array
        What is missing in its sum arrives later or never [1].
    """
    back, now = sparse.csr_array(matrix.T), np.asarray(start, float)
    arrived = np.empty(steps + 1)
    for step in range(steps + 1):
        now = back @ now if step else now
        arrived[step] = now[target].sum()
        now = np.where(target, 0.0, now)
    return arrived


def hitting_probability(matrix: sparse.csr_array, target: Set, avoided: Set) -> Array:
    """Probability of reaching a set before another one, from each state (committor).

    Parameters
    ----------
    matrix : (n_states, n_states) csr_array
        Row-stochastic.
    target, avoided : (n_states,) bool array
        The sets, without a common state.

    Returns
    -------
    (n_states,) array
        1 in the target, 0 in the other set and where the target is never reached [1].
    """
    link = sparse.csr_array(matrix > 0)
    arrives = _leads_to(link, target, ~avoided)
    share = target.astype(float)
    inner = np.flatnonzero(arrives & ~target & ~avoided)
    if inner.size:
        rows = matrix[inner]
        system = sparse.csc_array(sparse.eye_array(inner.size) - rows[:, inner])
        share[inner] = np.clip(solved(system, rows @ target.astype(float)), 0.0, 1.0)
    return share


def entry_distribution(matrix: sparse.csr_array, density: Array, inside: Set) -> Array:
    """Where particles enter a set in the long run, (n_states,), sum 1 [1].

    Parameters
    ----------
    matrix : (n_states, n_states) csr_array
        Row-stochastic.
    density : (n_states,) array
        Long-run density [1].
    inside : (n_states,) bool array
        The set.

    Returns
    -------
    (n_states,) array
        0 outside; NaN if none enters.
    """
    entered = np.where(inside, matrix.T @ np.where(inside, 0.0, density), 0.0)
    with np.errstate(invalid="ignore"):
        return np.asarray(entered / entered.sum())


def mean_passage(matrix: sparse.csr_array, density: Array, origin: Set, target: Set) -> float:
    """Mean steps from a set to another one, over the long-run density in the first; infinite if some stay."""
    steps, weights = first_passage_steps(matrix, target)[origin], density[origin]
    held = weights > 0
    return float(steps[held] @ weights[held] / weights.sum())


def mean_recurrence(density: Array, inside: Set) -> float:
    """Mean steps between two visits of a set in the long run, ``1 / density of the set`` (Kac 1947)."""
    held = float(density[inside].sum())
    return 1 / held if held > 0 else float("inf")


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
