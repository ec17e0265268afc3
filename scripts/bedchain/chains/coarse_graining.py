# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain on fewer states, and the error that it costs."""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.errors import DataError

Array = NDArray[np.float64]


def coarse_matrix(matrix: sparse.csr_array, density: Array, group: NDArray[np.integer]) -> sparse.csr_array:
    """Matrix between groups of states, ``sum_i density_i sum_j P_ij / sum_i density_i``.

    Parameters
    ----------
    matrix : (n_states, n_states) csr_array
        Row-stochastic.
    density : (n_states,) array
        Distribution in a group [1], such as the long-run density: it then stays that of the coarse chain.
    group : (n_states,) int array
        Group of each state, from 0 on.

    Returns
    -------
    (n_groups, n_groups) csr_array
        Row-stochastic; a group without particles keeps ``P[i, i] = 1``.

    Raises
    ------
    DataError
        A state has no group.
    """
    if len(group) != matrix.shape[0] or np.min(group) < 0:
        raise DataError(
            f"{len(group)} groups of {matrix.shape[0]} states: give each state a number from 0 on"
        )
    onto = membership(group)
    held = density @ onto
    weights = sparse.diags_array(np.asarray(density, float)) @ onto
    rows = sparse.csr_array(weights.T @ (matrix @ onto))
    empty = sparse.diags_array((held == 0).astype(float))
    coarse = sparse.csr_array(sparse.diags_array(1 / np.where(held > 0, held, 1)) @ rows + empty)
    return sparse.csr_array(sparse.diags_array(1 / coarse.sum(axis=1)) @ coarse)


def membership(group: NDArray[np.integer]) -> sparse.csr_array:
    """Ones where a state is in a group, (n_states, n_groups)."""
    n_states = len(group)
    return sparse.csr_array((np.ones(n_states), np.asarray(group), np.arange(n_states + 1)))


def coarse_error(
    matrix: sparse.csr_array, density: Array, group: NDArray[np.integer], steps: int
) -> tuple[Array, Array]:
    """Error of the coarse chain: total variation of its distribution over groups from the exact one.

    Parameters
    ----------
    matrix, density, group
        As `coarse_matrix`.
    steps : int

    Returns
    -------
    mean, largest : (steps + 1,) array
        At steps 0 to ``steps``, over the groups that the particles start in, distributed in them as the
        density: the mean weighted by their particles, and the largest [1]. Both are 0 at steps 0 and 1.
    """
    onto = membership(group)
    held = density @ onto
    starts = sparse.diags_array(1 / np.where(held > 0, held, 1)) @ (sparse.diags_array(density) @ onto).T
    fine, coarse = starts.toarray()[held > 0], np.eye(held.size)[held > 0]
    between, distance = coarse_matrix(matrix, density, group), np.empty((steps + 1, len(fine)))
    for step in range(steps + 1):
        distance[step] = 0.5 * np.abs(fine @ onto - coarse).sum(axis=1)
        fine, coarse = fine @ matrix, coarse @ between
    return distance @ held[held > 0] / held.sum(), distance.max(axis=1)
