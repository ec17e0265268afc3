# SPDX-License-Identifier: GPL-3.0-or-later
"""Residence times in cells, and passage times from the bottom of the bed to its top."""

import numpy as np
from numpy.typing import NDArray

from bedchain.chains.first_passage import first_passage_steps
from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.matrix_analysis import long_run_density
from bedchain.trajectory.grid import Grid


def residence_in_cells(
    chain: MarkovChain, start: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean time in each cell from entering to leaving it, over all states of the cell.

    Parameters
    ----------
    chain : MarkovChain
    start : (n_states,) array
        Distribution at the start [1].

    Returns
    -------
    residence_s : (n_cells,) array
        Particles in the cell over those that leave it in a unit of time, in the long run [s]; for the
        static chain ``lag_s / (1 - P_ii)``. Infinite where none leaves, NaN where there is none.
    density : (n_cells,) array
        Share of the particles in each cell in the long run [1].
    """
    states = long_run_density(chain.matrix, start)
    lengths = np.diff(chain.matrix.indptr)
    origin = np.repeat(chain.cell_of_state, lengths)
    leaving = np.repeat(states, lengths) * chain.matrix.data
    leaving *= origin != chain.cell_of_state[chain.matrix.indices]
    outflow = np.bincount(origin, leaving, chain.grid.n_cells)
    density = np.bincount(chain.cell_of_state, states, chain.grid.n_cells).astype(np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        return chain.lag_s * density / outflow, density


def top_row(density: NDArray[np.float64], grid: Grid, share: float) -> int:
    """Lowest row with at most a given share of the particles in it and above it.

    Parameters
    ----------
    density : (n_cells,) array
        Share of the particles in each cell [1].
    grid : Grid
    share : float
        [1].

    Returns
    -------
    int
        At least 1, never the bottom row.
    """
    by_row = grid.projected(density).reshape(grid.rows, grid.columns).sum(axis=1)
    above = by_row[::-1].cumsum()[::-1]
    high = np.flatnonzero(above <= share)
    return max(1, int(high[0]) if high.size else grid.rows - 1)


def passage_time(chain: MarkovChain, start: NDArray[np.float64], row: int) -> float:
    """Mean time until particles of the bottom row are first in a row or above it.

    Parameters
    ----------
    chain : MarkovChain
    start : (n_states,) array
        Particles in each state; those in the bottom row count.
    row : int
        The row to reach.

    Returns
    -------
    float
        [s]; infinite where some may never reach the row, NaN without particles at the bottom.
    """
    row_of_state = chain.grid.indices(chain.cell_of_state)[1]
    steps = first_passage_steps(chain.matrix, row_of_state >= row)
    at_bottom = np.where(row_of_state == 0, start, 0.0)
    if at_bottom.sum() == 0:
        return float("nan")
    held = at_bottom > 0
    return float(chain.lag_s * (steps[held] @ at_bottom[held]) / at_bottom.sum())


def arrived(cells: NDArray[np.int32], grid: Grid, row: int) -> NDArray[np.float64]:
    """Share of the particles of the bottom row that have been in a row or above it.

    Parameters
    ----------
    cells : (n_frames, n_particles) int array
        Cell of each particle.
    grid : Grid
    row : int
        The row to reach.

    Returns
    -------
    (n_frames,) array
        Of the particles in the bottom row in the first frame [1]; NaN if there are none.
    """
    rows = grid.indices(np.asarray(cells)[:, grid.indices(np.asarray(cells[0]))[1] == 0])[1]
    if rows.shape[1] == 0:
        return np.full(len(rows), np.nan)
    return np.asarray((np.maximum.accumulate(rows, axis=0) >= row).mean(axis=1))
