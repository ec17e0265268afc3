# SPDX-License-Identifier: GPL-3.0-or-later
"""The static chain: the next cell depends on the present cell alone (Zhuang et al. 2015, Eq. 1)."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains.counting import Counts, count_moves
from bedchain.chains.counting_by_block import BlockCounts, count_move_blocks
from bedchain.chains.estimators import (
    ESTIMATORS,
    estimated_rows,
    leak,
    transition_matrix,
    transition_matrix_with_openings,
    visited_density,
)
from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.matrix_analysis import long_run_density
from bedchain.measures.batch import total_variation
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid


def learn(
    frames: Frames,
    grid: Grid,
    lag: int = 1,
    estimator: str = "pooled",
    step_weights: NDArray[np.int64] | None = None,
    single: Counts | None = None,
) -> MarkovChain:
    """Static chain from a window of frames; arguments as `dynamic.learn`."""
    if single is None:
        single = count_moves(frames.cells, grid.n_cells, lag, step_weights=step_weights)
    return from_counts(single, grid, lag * frames.interval_s, estimator)


def relearner(
    frames: Frames, grid: Grid, lag: int = 1, estimator: str = "pooled", single: BlockCounts | None = None
) -> Callable[[NDArray[np.bool_]], MarkovChain]:
    """See `dynamic.relearner`."""
    blocks, lag_s = single or count_move_blocks(frames.cells, grid.n_cells, lag), lag * frames.interval_s
    return lambda kept: from_counts(blocks.of(kept), grid, lag_s, estimator)


def from_counts(counts: Counts, grid: Grid, lag_s: float, estimator: str = "pooled") -> MarkovChain:
    """Static chain from counted moves.

    Parameters
    ----------
    counts : Counts
        From `counting.count_moves`.
    grid : Grid
        The cells.
    lag_s : float
        Length of a step [s].
    estimator : {"literal", "per_step", "pooled"}
        How counts become probabilities.

    Returns
    -------
    MarkovChain
        Its states are the cells; its report is that of `report`, and the rows changed.
    """
    matrix, openings = transition_matrix_with_openings(counts, estimator)
    numbers = report(counts, matrix, estimator) | {
        "cells_never_left_1": float(openings.never_left.size),
        "cells_returned_1": float(openings.returned.size),
        "closed_classes_1": float(openings.closed_classes),
    }
    cells = np.arange(grid.n_cells, dtype=np.int32)
    return MarkovChain("static", grid, counts.lag, lag_s, matrix, cells, 1, np.zeros(0, np.int64), 0, numbers)


def report(counts: Counts, matrix: sparse.csr_array, estimator: str) -> dict[str, float]:
    """Numbers about a static matrix and its counts.

    Returns
    -------
    dict
        ``row_sum_error_1``: largest distance of the sum of a visited row from 1, as estimated;
        ``leak_1``: share of the particles lost in a step, as estimated;
        ``mass_1``: mass after one step of the final matrix from the visited density;
        ``visited_cells_1``, ``moves_1``, ``entries_1``: cells, moves, and entries of the matrix.
    """
    rows = np.asarray(estimated_rows(counts, estimator).sum(axis=1)).ravel()
    density = visited_density(counts)
    visited = counts.visits > 0
    return {
        "row_sum_error_1": float(np.abs(rows[visited] - 1).max()),
        "leak_1": leak(counts, density) if estimator == "literal" else 0.0,
        "mass_1": float((density @ matrix).sum()),
        "visited_cells_1": float(visited.sum()),
        "moves_1": float(counts.moves.sum()),
        "entries_1": float(matrix.nnz),
    }


def compare_estimators(counts: Counts) -> dict[str, dict[str, float]]:
    """`report` of each estimator, and ``long_run_total_variation_1``.

    The latter is the total variation of the chain's long-run density from the frames' mean density.
    """
    density = visited_density(counts)
    table = {}
    for estimator in ESTIMATORS:
        matrix = transition_matrix(counts, estimator)
        distance = total_variation(long_run_density(matrix, density), density)
        table[estimator] = report(counts, matrix, estimator) | {"long_run_total_variation_1": distance}
    return table
