# SPDX-License-Identifier: GPL-3.0-or-later
"""Estimators of a row-stochastic matrix from counts, with rules for what the counts leave undetermined."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains.classes import classes_of, open_classes
from bedchain.chains.counting import Counts
from bedchain.errors import DataError

# Sums of shares differ from whole numbers by the round-off of the counted steps only.
ROUND_OFF = 1e-11


@dataclass(frozen=True)
class Openings:
    """Rows to which the rules for undetermined cases applied.

    Parameters
    ----------
    never_left : (n,) int64 array
        Rows without counts and without a way back, ``P[i, i] = 1``.
    returned : (n,) int64 array
        Rows of closed classes that were opened (`classes.open_classes`).
    closed_classes : int
        Closed classes of visited cells that remain, the main one included [1].
    """

    never_left: NDArray[np.int64]
    returned: NDArray[np.int64]
    closed_classes: int


def transition_matrix(
    counts: Counts, estimator: str = "pooled", open_closed: bool | None = None
) -> sparse.csr_array:
    """Row-stochastic transition matrix of static counts (Zhuang et al. 2015, Eq. 1).

    Parameters
    ----------
    counts : Counts
        Of moves from cell to cell.
    estimator : {"literal", "per_step", "pooled"}
        See `ESTIMATORS`.
    open_closed : bool, optional
        Open closed classes (`open_classes`); by default for all but ``literal``.

    Returns
    -------
    (n_cells, n_cells) csr_array
        Rows sum to 1. A cell never left keeps ``P[i, i] = 1``; cell numbers never shift.
    """
    return transition_matrix_with_openings(counts, estimator, open_closed)[0]


def transition_matrix_with_openings(
    counts: Counts, estimator: str = "pooled", open_closed: bool | None = None
) -> tuple[sparse.csr_array, Openings]:
    """`transition_matrix`, and the rows to which the rules for undetermined cases applied."""
    matrix = sparse.csr_array(estimated_rows(counts, estimator))
    missing = 1.0 - matrix.sum(axis=1)
    missing[np.abs(missing) < ROUND_OFF] = 0.0
    matrix = sparse.csr_array(matrix + sparse.dia_array((missing[None, :], [0]), shape=matrix.shape))
    matrix.eliminate_zeros()
    returned = np.zeros(0, np.int64)
    if estimator != "literal" if open_closed is None else open_closed:
        matrix, returned = open_classes(matrix, counts)
    matrix = _normalised(matrix)
    unvisited = np.flatnonzero(counts.visits == 0)
    never_left = np.setdiff1d(unvisited, returned)
    counted = (counts.visits > 0) | (np.asarray(counts.moves.sum(axis=0)).ravel() > 0)
    label, closed = classes_of(matrix)
    remaining = np.unique(label[closed[label] & counted])
    return matrix, Openings(never_left, returned, remaining.size)


def literal(counts: Counts) -> sparse.csr_array:
    """Mean over all steps of N_ij / N_i, with 0 in steps in which i was empty: Eq. 1 as printed.

    Rows sum to the share of the steps in which the cell was occupied: the remainder leaks.
    """
    return sparse.csr_array(counts.shares / counts.steps)


def per_step(counts: Counts) -> sparse.csr_array:
    """Mean of N_ij / N_i over the steps in which i was occupied; rows of cells never occupied are empty."""
    return sparse.csr_array(_rows_divided(counts.shares, counts.occupied))


def pooled(counts: Counts) -> sparse.csr_array:
    """Sum of N_ij over sum of N_i, the maximum-likelihood estimate; rows of cells never left are empty.

    The mean density of the frames is stationary, but for the first and the last frame.
    """
    return sparse.csr_array(_rows_divided(counts.moves, counts.visits))


ESTIMATORS: dict[str, Callable[[Counts], sparse.csr_array]] = {
    "literal": literal,
    "per_step": per_step,
    "pooled": pooled,
}


def estimated_rows(counts: Counts, estimator: str) -> sparse.csr_array:
    """Rows of an estimator, before the rules for missing mass.

    Raises
    ------
    DataError
        The estimator is not in `ESTIMATORS`.
    """
    if estimator not in ESTIMATORS:
        raise DataError(f"estimator {estimator!r} is unknown: choose one of {', '.join(ESTIMATORS)}")
    return ESTIMATORS[estimator](counts)


def leak(counts: Counts, density: NDArray[np.float64] | None = None) -> float:
    """Share of the particles that Eq. 1 as printed loses in a step.

    Parameters
    ----------
    counts : Counts
        Counted moves.
    density : (n_from,) array, optional
        Distribution of the particles [1]; that of the counts by default.

    Returns
    -------
    float
        [1].
    """
    weights = visited_density(counts) if density is None else density
    return float(weights @ (1.0 - counts.occupied / counts.steps))


def visited_density(counts: Counts) -> NDArray[np.float64]:
    """Mean distribution of the particles at the starts of the steps, (n_from,), sum 1 [1]."""
    visits = counts.visits
    return np.asarray(visits / visits.sum())


def _rows_divided(matrix: sparse.csr_array, divisor: NDArray[np.int64]) -> sparse.csr_array:
    safe = np.where(divisor > 0, divisor, 1).astype(float)
    data = matrix.data / np.repeat(safe, np.diff(matrix.indptr))
    return sparse.csr_array((data, matrix.indices, matrix.indptr), shape=matrix.shape)


def with_sorted_rows(matrix: sparse.csr_array) -> sparse.csr_array:
    """The same matrix with int32 indices, rising in each row."""
    index = (matrix.indices.astype(np.int32), matrix.indptr.astype(np.int32))
    matrix = sparse.csr_array((matrix.data, *index), shape=matrix.shape)
    matrix.sort_indices()
    return matrix


def _normalised(matrix: sparse.csr_array) -> sparse.csr_array:
    """Matrix whose rows sum to 1 as closely as floating point allows."""
    sums = np.repeat(np.asarray(matrix.sum(axis=1)).ravel(), np.diff(matrix.indptr))
    shares = sparse.csr_array((matrix.data / sums, matrix.indices, matrix.indptr), shape=matrix.shape)
    return with_sorted_rows(shares)
