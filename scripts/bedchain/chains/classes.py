# SPDX-License-Identifier: GPL-3.0-or-later
"""Communicating classes of a transition matrix, and the opening of closed ones."""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from bedchain.chains.counting import Counts


def classes_of(matrix: sparse.csr_array) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """Communicating classes.

    Returns
    -------
    label : (n_states,) int64 array
        Class of each state.
    closed : (n_classes,) bool array
        True for classes that are never left.
    """
    n_classes, label = csgraph.connected_components(matrix, directed=True, connection="strong")
    rows = np.repeat(np.arange(matrix.shape[0]), np.diff(matrix.indptr))
    crossing = (label[rows] != label[matrix.indices]) & (matrix.data > 0)
    closed = np.ones(n_classes, bool)
    closed[label[rows[crossing]]] = False
    return label.astype(np.int64), closed


def closed_classes(matrix: sparse.csr_array) -> list[NDArray[np.int64]]:
    """Sets of states that are never left once entered, each rising, largest first."""
    label, closed = classes_of(matrix)
    states = np.flatnonzero(closed[label])
    states = states[np.argsort(label[states], kind="stable")]
    classes = np.split(states, np.flatnonzero(np.diff(label[states])) + 1)
    return sorted(classes, key=len, reverse=True)


def traps(matrix: sparse.csr_array, visits: NDArray[np.int64]) -> NDArray[np.int64]:
    """Closed class of each state, -1 for open classes and the main class; (n_states,).

    The main class is the communicating class with the most visits, closed or not.
    """
    label, closed = classes_of(matrix)
    closed[np.argmax(np.bincount(label, weights=visits))] = False
    return np.where(closed[label], label, -1)


def open_classes(matrix: sparse.csr_array, counts: Counts) -> tuple[sparse.csr_array, NDArray[np.int64]]:
    """Matrix without closed classes that only the end of the window closes, as by a move in its last frame.

    To the counts of every closed class that particles entered, the main one excepted (`traps`), the moves
    into it are added in reverse: particles return the way they came. Otherwise a particle that enters such
    a class never returns, and the long-run density of the chain collapses onto it. A class that no particle
    entered (never visited, or separate from the start) is not changed.

    Returns
    -------
    matrix : csr_array
        Its row sums are those of the given matrix.
    returned : int64 array
        Rows that were changed, rising.
    """
    moves = sparse.coo_array(counts.moves)
    changed = np.zeros(matrix.shape[0], bool)
    while True:
        trap = traps(matrix, counts.visits)
        entering = (trap[moves.col] >= 0) & (trap[moves.row] != trap[moves.col])
        if not entering.any():
            return matrix, np.flatnonzero(changed)
        back = sparse.csr_array(
            (moves.data[entering].astype(float), (moves.col[entering], moves.row[entering])),
            shape=matrix.shape,
        )
        returning = np.asarray(back.sum(axis=1)).ravel()
        total = np.where(returning > 0, counts.visits + returning, 1.0)
        kept = np.where(returning > 0, counts.visits / total, 1.0)
        matrix = sparse.csr_array(sparse.diags_array(kept) @ matrix + sparse.diags_array(1.0 / total) @ back)
        matrix.eliminate_zeros()
        # Each row is changed once at most: it now leads to all states that led to it.
        changed |= returning > 0
