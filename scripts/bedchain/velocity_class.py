# SPDX-License-Identifier: GPL-3.0-or-later
"""The velocity-class chain: the next cell and velocity depend on the present cell and velocity.

A state is a cell times a class of the velocity (vx, vz), classes of equally many particles each over the
whole learning window. Assumed: within a class the velocity does not matter, what was before the present
velocity does not matter, and positions are even in a cell. Where particles soon turn back, as between the
bubbles of a narrow bed, the second makes them mix too fast: with ``earlier_s`` the class of the velocity so
long ago is part of the state too. States with few samples move as any particle of their cell does, whatever
its velocity, so that the matrix stays sparse and conservative.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.counting import Counts, count_moves, step_starts
from bedchain.estimators import leak, open_classes, transition_matrix
from bedchain.frames import DataError, Frames, lag_frames
from bedchain.grid import Grid
from bedchain.markov_chain import MarkovChain
from bedchain.velocity import VelocityClasses, measured, quantile_classes

CLASSES = (3, 3)
# States with fewer samples move as their cell does: the shares of their few moves would be off by a third.
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
        As `models.learn`. The edges of the classes are those of the window, whatever its steps weigh.
    classes : (n_x, n_z)
        Classes of the velocity along x and z [1].
    fewest_samples : int
        States seen less often than this move as any particle of their cell does [1].
    earlier_s : float
        The class of the velocity so long ago counts too, a multiple of the frame interval [s]; 0 for none.

    Returns
    -------
    MarkovChain
    """
    _, weights = step_starts(frames.cells, lag, step_weights=step_weights)
    return relearner(frames, grid, lag, estimator, classes, fewest_samples, earlier_s)(weights)


def relearner(
    frames: Frames,
    grid: Grid,
    lag: int = 1,
    estimator: str = "pooled",
    classes: Sequence[int] = CLASSES,
    fewest_samples: int = FEWEST_SAMPLES,
    earlier_s: float = 0.0,
) -> Callable[[NDArray[np.int64]], MarkovChain]:
    """`learn` as a function of ``step_weights`` that knows all states already; arguments as `learn`."""
    back = lag_frames(earlier_s, frames.interval_s) if earlier_s else 0
    if len(frames.times_s) - lag <= back:
        raise DataError(
            f"{len(frames.times_s)} frames hold no step of {lag} frames after {back}: "
            "widen the window or cut earlier_s"
        )
    edges, states = _states(frames, grid, classes, back)
    n_states, lag_s = grid.n_cells * edges.number, lag * frames.interval_s
    note = {"velocities_from_differences_1": float(not measured(frames))}

    def again(weights: NDArray[np.int64]) -> MarkovChain:
        counts = count_moves(states, n_states, lag, step_weights=weights[back:])
        chain = from_counts(counts, edges, grid, lag_s, estimator, fewest_samples)
        return replace(chain, report=chain.report | note)

    return again


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
        From `counting.count_moves`, with states ``cell * classes.number + class`` in the place of cells.
    classes : VelocityClasses
    grid : Grid
        The cells.
    lag_s : float
        Length of a step [s].
    estimator : {"literal", "per_step", "pooled"}
        How counts become probabilities, but for the rows of whole cells, which are pooled.
    fewest_samples : int
        States with fewer samples get the row of their cell [1].

    Returns
    -------
    MarkovChain
        Its report holds how many of the visited states had fewer samples, and which share of all moves began
        in one of them: these fall back on the row of their cell.

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
    cell_of_state = np.repeat(np.arange(grid.n_cells, dtype=np.int32), classes.number)
    visits = counts.visits
    fills = np.bincount(cell_of_state, visits, grid.n_cells)[cell_of_state] > 0
    thin = (visits < fewest_samples) & fills
    of_cells = _rows_of_cells(counts.moves, cell_of_state, grid.n_cells)
    moves = _replaced(counts.moves, of_cells, cell_of_state, thin)
    total = np.maximum(of_cells.sum(axis=1), 1)
    of_cells = sparse.csr_array(sparse.diags_array(1.0 / total) @ of_cells)
    matrix = _replaced(transition_matrix(counts, estimator, False), of_cells, cell_of_state, thin)
    returned = np.zeros(0, np.int64)
    if estimator != "literal":
        matrix, returned = open_classes(matrix, replace(counts, moves=moves))
    seen = visits > 0
    report = {
        "states_1": float(seen.sum()),
        "thin_state_share_1": float((thin & seen).sum() / seen.sum()),
        "fallback_share_1": float(visits[thin].sum() / visits.sum()),
        "leak_1": leak(counts) if estimator == "literal" else 0.0,
        "states_returned_1": float(returned.size),
        "moves_1": float(visits.sum()),
        "entries_1": float(matrix.nnz),
    }
    none = np.zeros(0, np.int64)
    return MarkovChain(
        "velocity_class", grid, counts.lag, lag_s, matrix, cell_of_state, 1, none, 0, report, classes
    )


def _states(
    frames: Frames, grid: Grid, classes: Sequence[int], back: int
) -> tuple[VelocityClasses, NDArray[np.int32]]:
    """Classes of a window, and the state of each particle in each frame that ``back`` lead up to."""
    edges = quantile_classes(frames, classes, back)
    if grid.n_cells * edges.number > np.iinfo(np.int32).max:
        raise DataError(f"{grid.n_cells} cells by {edges.number} classes: state numbers must fit in int32")
    states = edges.of(frames)
    for now, cells in zip(states, frames.cells[back:], strict=True):
        now += np.int32(edges.number) * np.asarray(cells)
    return edges, states


def _rows_of_cells(
    moves: sparse.csr_array, cell_of_state: NDArray[np.int32], n_cells: int
) -> sparse.csr_array:
    """Moves of the states of each cell together, (n_cells, n_states)."""
    n_states = cell_of_state.size
    index = (cell_of_state, np.arange(n_states))
    together = sparse.csr_array((np.ones(n_states, moves.dtype), index), shape=(n_cells, n_states))
    return sparse.csr_array(together @ moves)


def _replaced(
    rows: sparse.csr_array,
    of_cells: sparse.csr_array,
    cell_of_state: NDArray[np.int32],
    thin: NDArray[np.bool_],
) -> sparse.csr_array:
    """Rows of states, those of thin ones replaced by the rows of their cells."""
    source = np.where(thin, thin.size + cell_of_state, np.arange(thin.size))
    return sparse.csr_array(sparse.csr_array(sparse.vstack((rows, of_cells), format="csr"))[source])
