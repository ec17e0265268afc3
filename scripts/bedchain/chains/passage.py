# SPDX-License-Identifier: GPL-3.0-or-later
"""How long particles stay in a cell, and how long they need from the bottom of the bed to its top."""

import numpy as np
from numpy.typing import NDArray

from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.matrix_analysis import first_passage_steps, long_run_density
from bedchain.trajectory.grid import Grid


def residence_in_cells(
    chain: MarkovChain, start: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean time in each cell from entering to leaving it, whatever states the cell holds.

    Parameters
    ----------
    chain : MarkovChain
    start : (n_states,) array
        Distribution at the start [1].

    Returns
    -------
    residence_s : (n_cells,) array
        What is in the cell over what leaves it in a step, in the long run [s]; for the static chain
        `matrix_analysis.residence_steps`. Infinite where nothing leaves, NaN where nothing is.
    density : (n_cells,) array
        Share of the particles in each cell in the long run [1].
    """
    states = long_run_density(chain.matrix, start)
    lengths = np.diff(chain.matrix.indptr)
    left = np.repeat(chain.cell_of_state, lengths) != chain.cell_of_state[chain.matrix.indices]
    leaving = np.repeat(states, lengths) * chain.matrix.data * left
    origin = np.repeat(chain.cell_of_state, lengths)
    outflow = np.bincount(origin, leaving, chain.grid.n_cells)
    density = np.bincount(chain.cell_of_state, states, chain.grid.n_cells).astype(np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        return chain.lag_s * density / outflow, density


def top_row(density: NDArray[np.float64], grid: Grid, share: float) -> int:
    """Lowest row such that at most a share of the particles is in it and above.

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
        At least 1: never the bottom row itself.
    """
    by_row = density.reshape(grid.rows, grid.columns).sum(axis=1)
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
        [s]; infinite where some may never get there, NaN without particles at the bottom.
    """
    height = chain.cell_of_state // chain.grid.columns
    steps = first_passage_steps(chain.matrix, height >= row)
    from_bottom = np.where(height == 0, start, 0.0)
    if from_bottom.sum() == 0:
        return float("nan")
    there = from_bottom > 0
    return float(chain.lag_s * (steps[there] @ from_bottom[there]) / from_bottom.sum())


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
        Of the particles that are in the bottom row in the first frame [1]; NaN without any.
    """
    height = np.asarray(cells)[:, np.asarray(cells[0]) < grid.columns] // grid.columns
    if height.shape[1] == 0:
        return np.full(len(height), np.nan)
    return np.asarray((np.maximum.accumulate(height, axis=0) >= row).mean(axis=1))
