# SPDX-License-Identifier: GPL-3.0-or-later
"""The velocity-class chain: the next cell and velocity depend on the present cell and velocity.

A state is a cell and a class of the velocity (vx, vz); each class has equally many particles over the whole
learning window. Assumed: within a class the velocity does not matter, earlier velocities do not matter, and
particles are spread evenly over a cell. Where particles soon turn back, as between the bubbles of a narrow
bed, the second assumption makes them mix too fast: with ``earlier_s`` the class of the velocity so long ago
is part of the state too, with as many more states (3 x 3 classes twice are 81). States with few samples move
as any particle of their cell does, so that the matrix stays sparse and conservative.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains.classes import open_classes
from bedchain.chains.counting import Counts, count_moves, step_starts
from bedchain.chains.counting_by_block import count_move_blocks
from bedchain.chains.estimators import leak, transition_matrix, with_sorted_rows
from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.velocity_binning import VelocityClasses, measured, quantile_classes
from bedchain.errors import DataError
from bedchain.trajectory.frames import Frames, lag_frames
from bedchain.trajectory.grid import OUTSIDE, Grid

CLASSES = (3, 3)
# States with fewer samples move as their cell does: their own shares would have errors of a third.
FEWEST_SAMPLES = 10


def learn(
    frames: Frames,
    grid: Grid,
    lag: int = 1,
    estimator: str = "pooled",
    step_weights: NDArray[np.int64] | None = None,
    classes: Sequence[int] = CLASSES,
    fewest_samples: int = FEWEST_SAMPLES,
    earlier_s: float = 0.0,
) -> MarkovChain:
    """Velocity-class chain from a window of frames.

    Parameters
    ----------
    frames, grid, lag, estimator, step_weights
        As `registry.learn`. The edges of the classes do not depend on the weights.
    classes : (n_x, n_z)
        Classes of the velocity along x and z [1].
    fewest_samples : int
        States with fewer samples move as any particle of their cell does [1].
    earlier_s : float
        Time before the present at which the velocity counts too, a multiple of the frame interval [s]; 0 for
        the present velocity alone.

    Returns
    -------
    MarkovChain
    """
    _, weights = step_starts(frames.cells, lag, step_weights=step_weights)
    window = _Window.of(frames, grid, lag, classes, earlier_s)
    counts = count_moves(window.states, window.n_states, lag, step_weights=weights[window.classes.back :])
    return window.chain(counts, grid, estimator, fewest_samples)


def relearner(
    frames: Frames,
    grid: Grid,
    lag: int = 1,
    estimator: str = "pooled",
    classes: Sequence[int] = CLASSES,
    fewest_samples: int = FEWEST_SAMPLES,
    earlier_s: float = 0.0,
) -> Callable[[NDArray[np.bool_]], MarkovChain]:
    """See `registry.relearner`; states are computed and moves are counted only once. Arguments as `learn`."""
    window = _Window.of(frames, grid, lag, classes, earlier_s)
    blocks = count_move_blocks(window.states, window.n_states, lag, window.classes.back)
    return lambda kept: window.chain(blocks.of(kept), grid, estimator, fewest_samples)


class _Window(NamedTuple):
    """States of the particles of a learning window, (n_frames - back, n_particles), and their classes."""

    states: NDArray[np.int32]
    n_states: int
    classes: VelocityClasses
    lag_s: float
    note: dict[str, float]

    @classmethod
    def of(cls, frames: Frames, grid: Grid, lag: int, classes: Sequence[int], earlier_s: float) -> "_Window":
        back = lag_frames(earlier_s, frames.interval_s) if earlier_s else 0
        if len(frames.times_s) - lag <= back:
            raise DataError(
                f"{len(frames.times_s)} frames hold no step of {lag} frames after {back}: "
                "widen the window or cut earlier_s"
            )
        edges, states = _states(frames, grid, classes, back)
        note = {"velocities_from_differences_1": float(not measured(frames))}
        return cls(states, grid.n_cells * edges.number, edges, lag * frames.interval_s, note)

    def chain(self, counts: Counts, grid: Grid, estimator: str, fewest_samples: int) -> MarkovChain:
        chain = from_counts(counts, self.classes, grid, self.lag_s, estimator, fewest_samples)
        return replace(chain, report=chain.report | self.note)


def from_counts(
    counts: Counts,
    classes: VelocityClasses,
    grid: Grid,
    lag_s: float,
    estimator: str = "pooled",
    fewest_samples: int = FEWEST_SAMPLES,
) -> MarkovChain:
    """Velocity-class chain from counted moves between states.

    Parameters
    ----------
    counts : Counts
        From `counting.count_moves`, with states ``cell * classes.number + class`` for cells.
    classes : VelocityClasses
    grid : Grid
        The cells.
    lag_s : float
        Length of a step [s].
    estimator : {"literal", "per_step", "pooled"}
        How counts become probabilities; the rows of whole cells are always pooled.
    fewest_samples : int
        States with fewer samples move as any particle of their cell does [1].

    Returns
    -------
    MarkovChain
        Its states are those with enough samples, followed by one state for each cell, which moves as all
        particles of the cell do and stands for the cell's thin states (too few samples). Its report holds the
        share of thin states among the visited ones, and the share of all moves that began in thin states.

    Raises
    ------
    DataError
        The counts are not of these states.
    """
    n_states = grid.n_cells * classes.number
    if counts.moves.shape != (n_states, n_states):
        raise DataError(
            f"counts of {counts.moves.shape[0]} states, {n_states} (cells times classes) expected"
        )
    cell = np.arange(n_states, dtype=np.int32) // np.int32(classes.number)
    visits = counts.visits
    kept = np.flatnonzero(visits >= max(fewest_samples, 1)).astype(np.int64)
    place = kept.size + cell.astype(np.int64)
    place[kept] = np.arange(kept.size)
    onto = _ones(np.arange(n_states), place, (n_states, kept.size + grid.n_cells))
    cell_moves = _ones(cell, np.arange(n_states), (grid.n_cells, n_states)) @ counts.moves @ onto
    shares = (transition_matrix(counts, estimator, False)[kept] @ onto, _shares(cell_moves, kept.size))
    matrix, returned = sparse.csr_array(sparse.vstack(shares, format="csr")), np.zeros(0, np.int64)
    if estimator != "literal":
        # Each move once: moves from thin states in the rows of their cells.
        moves = sparse.csr_array(onto.T @ counts.moves @ onto)
        matrix, returned = open_classes(matrix, replace(counts, moves=moves))
    matrix = with_sorted_rows(matrix)
    report = _report(visits, kept) | {
        "leak_1": leak(counts) if estimator == "literal" else 0.0,
        "states_returned_1": float(returned.size),
        "moves_1": float(visits.sum()),
        "entries_1": float(matrix.nnz),
    }
    cells = np.concatenate((cell[kept], np.arange(grid.n_cells, dtype=np.int32)))
    return MarkovChain(
        "velocity_class", grid, counts.lag, lag_s, matrix, cells, 1, kept, kept.size, report, classes
    )


def _report(visits: NDArray[np.int64], kept: NDArray[np.int64]) -> dict[str, float]:
    """Numbers of visited and of thin states, and the share of the moves that begin in thin states."""
    visited = float((visits > 0).sum())
    return {
        "states_1": visited,
        "thin_state_share_1": 1 - kept.size / visited,
        "fallback_share_1": 1 - float(visits[kept].sum() / visits.sum()),
    }


def _states(
    frames: Frames, grid: Grid, classes: Sequence[int], back: int
) -> tuple[VelocityClasses, NDArray[np.int32]]:
    """Classes of a window, and the state of each particle in each frame from number ``back`` on."""
    edges = quantile_classes(frames, classes, back)
    if grid.n_cells * edges.number > np.iinfo(np.int32).max:
        raise DataError(f"{grid.n_cells} cells by {edges.number} classes: state numbers must fit in int32")
    states = edges.of(frames)
    for now, cells in zip(states, frames.cells[back:], strict=True):
        now += np.int32(edges.number) * np.asarray(cells)
        np.maximum(now, OUTSIDE, out=now)  # of particles that are not there
    return edges, states


def _ones(
    rows: NDArray[np.integer], columns: NDArray[np.integer], shape: tuple[int, int]
) -> sparse.csr_array:
    """Matrix of ones at the given places: a product with it sums states with the same row or column."""
    return sparse.csr_array(sparse.coo_array((np.ones(rows.size, np.int64), (rows, columns)), shape=shape))


def _shares(moves: sparse.csr_array, first: int) -> sparse.csr_array:
    """Shares of the moves of each cell; cells never left stay in their state, number ``first + cell``."""
    total = np.asarray(moves.sum(axis=1)).ravel()
    never = np.flatnonzero(total == 0)
    stay = sparse.coo_array((np.ones(never.size), (never, first + never)), shape=moves.shape)
    return sparse.csr_array(sparse.diags_array(1.0 / np.maximum(total, 1)) @ moves + stay)
