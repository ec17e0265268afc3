# SPDX-License-Identifier: GPL-3.0-or-later
"""A batch of particles from the bottom of the bed, and its distribution over the cells."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import special

from bedchain.errors import UserError
from bedchain.trajectory.cell_store import CellStore, frame_at
from bedchain.trajectory.grid import Grid


@dataclass(frozen=True)
class Batch:
    """The batch of Figs. 3 and 4, and when it is looked at.

    Attributes
    ----------
    batch_height_m : float
        The batch is what is in the rows of cells below this height at the start [m].
    moments_s : list of float
        Rising times after the start [s].
    """

    batch_height_m: float
    moments_s: list[float]


def batch_of(grid: Grid, cells: np.ndarray, height_m: float) -> np.ndarray:
    """The batch: particles in the lowest rows of cells.

    Parameters
    ----------
    grid : Grid
    cells : (n_particles,) integer array
        Cell of each particle.
    height_m : float
        Height of the batch [m], rounded to whole rows, at least one; in rows that lie along something else
        than z, the middles of its cells are below it.

    Returns
    -------
    (n_particles,) ndarray of bool
        True for the particles of the batch.

    Raises
    ------
    UserError
        The batch is empty.
    """
    if grid.rows_are_heights:
        rows = max(1, round(height_m / grid.cell_height_m))
        batch = grid.indices(cells)[1] < rows
    else:
        rows, batch = 0, grid.centres_m[cells, 1] < height_m
    if not batch.any():
        place = (
            f"in the lowest {rows} rows of cells"
            if rows
            else f"in a cell whose middle is below {height_m:g} m"
        )
        raise UserError(f"no particle is {place}: raise figures.batch_height_m")
    return np.asarray(batch & (cells >= 0))


def share_by_cell(cells: np.ndarray, n_cells: int) -> np.ndarray:
    """Share of the particles in each cell.

    Parameters
    ----------
    cells : (n_particles,) integer array
        Cell of each particle; those that are not there (`grid.OUTSIDE`) do not count.
    n_cells : int
        Number of cells [1].

    Returns
    -------
    (n_cells,) ndarray
        Shares with the sum 1 [1].
    """
    seen = cells[cells >= 0]
    return np.asarray(np.bincount(seen, minlength=n_cells) / seen.size)


def observed_shares(
    store: CellStore, moments_s: np.ndarray, start_s: float, batch_height_m: float
) -> np.ndarray:
    """Distribution of the batch over the cells in the DEM.

    Parameters
    ----------
    store : CellStore
    moments_s : (n_moments,) ndarray
        Times after the start [s].
    start_s : float
        Time at which the batch is marked [s].
    batch_height_m : float
        Height of the batch [m].

    Returns
    -------
    (n_moments, n_cells) ndarray
        Shares of the batch [1].
    """
    start = frame_at(store.times_s, start_s)
    batch = batch_of(store.grid, np.asarray(store.cells[start]), batch_height_m)
    frames = [frame_at(store.times_s, store.times_s[start] + moment) for moment in moments_s]
    return np.array([share_by_cell(store.cells[frame][batch], store.grid.n_cells) for frame in frames])


def expected_total_variation(shares: NDArray[np.float64], number: int) -> float:
    """Total-variation distance that particles drawn from a distribution over cells have from it, expected.

    By the mean deviation of a binomial number from its mean, 2 n p (1 - p) times the probability of
    floor(n p) among n - 1 (De Moivre's theorem: Diaconis and Zabell, Statist. Sci. 6 (1991) 284).

    Parameters
    ----------
    shares : (n_cells,) array
        Probabilities [1].
    number : int
        Particles drawn [1].

    Returns
    -------
    float
        0 to 1 [1].
    """
    chance = shares[shares > 0] / shares.sum()
    chance = chance[chance < 1]  # the only cell gets all of them
    drawn, others = np.floor(number * chance), number - 1 - np.floor(number * chance)
    # by logarithms of the factorials: scipy.stats takes a second to load
    ways = special.gammaln(number) - special.gammaln(drawn + 1) - special.gammaln(others + 1)
    probability = np.exp(ways + special.xlogy(drawn, chance) + special.xlog1py(others, -chance))
    return float((chance * (1 - chance) * probability).sum())


def total_variation(p: NDArray[np.float64], q: NDArray[np.float64]) -> float:
    """Total-variation distance of two distributions over cells, each scaled to the sum 1; 0 to 1 [1]."""
    return float(0.5 * np.abs(p / p.sum() - q / q.sum()).sum())
