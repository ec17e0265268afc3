# SPDX-License-Identifier: GPL-3.0-or-later
"""Is the bed Markov on these cells at this lag? Chapman-Kolmogorov test and timescales over lags."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bedchain import chains, mixing
from bedchain.counting import count_moves
from bedchain.diagnostics import implied_timescales
from bedchain.estimators import transition_matrix, visited_density
from bedchain.frames import Frames
from bedchain.grid import Grid


@dataclass(frozen=True)
class ChapmanKolmogorov:
    """Mixing after k steps of one lag against one step of k lags.

    Parameters
    ----------
    times_s : (n,) array
        Length of k lags [s].
    predicted : (n, 4) array
        Share of each group of `mixing.GROUPS` still on its side after k steps of the chain of one lag.
    estimated : (n, 4) array
        The same by one step of a chain learned at k lags: what the frames show.
    """

    times_s: NDArray[np.float64]
    predicted: NDArray[np.float64]
    estimated: NDArray[np.float64]

    @property
    def error(self) -> NDArray[np.float64]:
        """Predicted less estimated, (n, 4) [1]."""
        return self.predicted - self.estimated


def chapman_kolmogorov(
    frames: Frames,
    grid: Grid,
    split_x_m: float,
    split_z_m: float,
    multiples: Sequence[int],
    lag: int = 1,
    estimator: str = "pooled",
    step_weights: NDArray[np.int64] | None = None,
) -> ChapmanKolmogorov:
    """Chapman-Kolmogorov test ``P(k lag) = P(lag)^k`` on the mixing curves of the static chain.

    Parameters
    ----------
    frames : Frames
        The learning window.
    grid : Grid
        Its cells.
    split_x_m, split_z_m : float
        Lines between left and right, and between low and up [m].
    multiples : sequence of int
        The numbers k of lags, rising.
    lag : int
        Frames in a step of the chain tested.
    estimator : str
        See `estimators.ESTIMATORS`.
    step_weights : (n_frames - lag,) int array, optional
        How many times the step starting at each frame counts (bootstrap).

    Returns
    -------
    ChapmanKolmogorov
        Groups are marked in the window's mean density, by the share of each cell on their side.
    """
    shares = mixing.side_shares(grid, split_x_m, split_z_m)
    base = count_moves(frames.cells, grid.n_cells, lag, step_weights=step_weights)
    start = shares * visited_density(base)
    pick = np.arange(4)
    far = chains.expected_values(transition_matrix(base, estimator), start, shares, max(multiples))
    estimated = []
    for k in multiples:
        counts = count_moves(frames.cells, grid.n_cells, k * lag, step_weights=step_weights)
        one = chains.expected_values(transition_matrix(counts, estimator), start, shares, 1)
        estimated.append(one[1][pick, pick])
    times = np.asarray(multiples) * lag * frames.interval_s
    return ChapmanKolmogorov(times, far[list(multiples)][:, pick, pick], np.array(estimated))


def timescales_over_lags(
    frames: Frames, grid: Grid, lags: Sequence[int], n: int = 5, estimator: str = "pooled"
) -> NDArray[np.float64]:
    """Implied timescales of static chains learned at several lags: level where the chain is Markov.

    Parameters
    ----------
    frames : Frames
        The learning window.
    grid : Grid
        Its cells.
    lags : sequence of int
        Frames in a step.
    n : int
        Timescales wanted.
    estimator : str
        See `estimators.ESTIMATORS`.

    Returns
    -------
    (n_lags, n) array
        Slowest first [s]; NaN where there are fewer.
    """
    table = np.full((len(lags), n), np.nan)
    for row, lag in enumerate(lags):
        matrix = transition_matrix(count_moves(frames.cells, grid.n_cells, lag), estimator)
        found = implied_timescales(matrix, lag * frames.interval_s, n)
        table[row, : found.size] = found
    return table
