# SPDX-License-Identifier: GPL-3.0-or-later
"""Marked particles over time: by the DEM, by one chain, and by a chain each for them and the rest."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.chains import propagate, static
from bedchain.chains.counting import count_moves
from bedchain.measures.marks import MEASURES, separation, variation_limits
from bedchain.trajectory.grid import Grid
from bedchain.uncertainty.bands import block_band, kept_blocks, kept_steps, means_left_out

Array = NDArray[np.floating]
# Monte Carlo runs of every particle whose mean the curves of a chain are
RUNS = 5


class Mixture(NamedTuple):
    """What the chains of a mixture are learned from and start with.

    Attributes
    ----------
    grid : Grid
    learned : (n_frames, n_particles) int array
        Cells in the learning window.
    compared : (n_frames, n_particles) int array
        Cells in the comparison window; chains start in its first frame.
    marked : (n_particles,) bool array
    lasts : bool
        Whether the mark is a property of the particles, so that they can have a chain of their own.
    lag, interval_s : int, float
        Frames in a step, and time between frames [s].
    """

    grid: Grid
    learned: NDArray[np.int32]
    compared: NDArray[np.int32]
    marked: NDArray[np.bool_]
    lasts: bool
    lag: int
    interval_s: float

    @property
    def steps(self) -> int:
        """Whole steps in the comparison window [1]."""
        return (len(self.compared) - 1) // self.lag


def curves(cells: Iterator[NDArray[np.int32]], marked: NDArray[np.bool_], grid: Grid) -> Array:
    """`marks.separation` of frames of cells, (n_frames, 3); particles that are not there do not count."""
    heights, rows = grid.centres_m[:, 1], []
    for now in cells:
        seen = now >= 0
        held = [np.bincount(now[seen & which], minlength=grid.n_cells) for which in (marked, marked | True)]
        rows.append(separation(held[0], held[1], heights))
    return np.array(rows)


def of_chains(mixture: Mixture, by_mark: bool, seed: int) -> Callable[[NDArray[np.bool_]], Array]:
    """Curves of the chains learned from the blocks of the learning window that are kept.

    Parameters
    ----------
    mixture : Mixture
    by_mark : bool
        A static chain for the marked and one for the others, instead of one for all.
    seed : int
        Of the Monte Carlo runs; the same for all blocks.

    Returns
    -------
    callable
        From the blocks that are kept, (BLOCKS,) bools, to curves, (steps + 1, 3).
    """
    grid, lag, start = mixture.grid, mixture.lag, mixture.compared[0]
    present = start >= 0
    groups = [mixture.marked, ~mixture.marked] if by_mark else [np.ones(start.size, bool)]
    n_steps = len(mixture.learned) - lag

    def learned(kept: NDArray[np.bool_]) -> Array:
        weights, matrices = kept_steps(kept, n_steps), []
        for group in groups:
            counts = count_moves(mixture.learned[:, group], grid.n_cells, lag, step_weights=weights)
            matrices.append(static.from_counts(counts, grid, lag * mixture.interval_s).matrix)
        runs = []
        for rng in np.random.default_rng(seed).spawn(RUNS):
            paths = np.full((mixture.steps + 1, start.size), -1, np.int32)
            for group, matrix in zip(groups, matrices, strict=True):
                here = group & present
                paths[:, here] = propagate.simulate(matrix, start[here], mixture.steps, rng)
            runs.append(curves(iter(paths), mixture.marked, grid))
        return np.mean(runs, axis=0)

    return learned


def segregation_table(mark: str, mixture: Mixture, seed: int) -> pd.DataFrame:
    """Table of a mark over time and its means, for DEM and chains, with bands.

    Bands of a chain are by blocks of the learning window; that of the DEM's mean by blocks of the comparison
    window. A curve of the DEM is one realisation and has none.

    Parameters
    ----------
    mark : str
        Its name.
    mixture : Mixture
    seed : int
        Of the Monte Carlo runs.

    Returns
    -------
    DataFrame
        mark, quantity, source, time_s (from the start on; empty for means over the second half), value,
        ci_low, ci_high; sources dem, chain, chain_by_mark, and separated and random for the limits of the
        variation.
    """
    lag_s, half = mixture.lag * mixture.interval_s, mixture.steps // 2
    times = lag_s * np.arange(mixture.steps + 1)
    frames = iter(mixture.compared[:: mixture.lag][: mixture.steps + 1])
    dem = curves(frames, mixture.marked, mixture.grid)
    nothing = np.full(dem.shape, np.nan)
    late = dem[half:]
    parts = [
        _rows("dem", times, dem, nothing, nothing),
        _means("dem", late.mean(axis=0), means_left_out(late)),
    ]
    for source, by_mark in (("chain", False), *((("chain_by_mark", True),) if mixture.lasts else ())):
        of = of_chains(mixture, by_mark, seed)
        blocks = kept_blocks()
        whole, left_out = of(np.ones(len(blocks), bool)), np.stack([of(kept) for kept in blocks])
        parts.append(_rows(source, times, whole, *block_band(whole, left_out)))
        parts.append(_means(source, whole[half:].mean(axis=0), left_out[:, half:].mean(axis=1)))
    seen = mixture.compared[0] >= 0
    total = np.bincount(mixture.compared[0][seen], minlength=mixture.grid.n_cells)
    limits = variation_limits(total, float(mixture.marked[seen].mean()))
    for source, limit in zip(("separated", "random"), limits, strict=True):
        row = {"quantity": "coefficient_of_variation", "source": source, "time_s": [0.0], "value": limit}
        parts.append(pd.DataFrame(row | {"ci_low": np.nan, "ci_high": np.nan}))
    table = pd.concat(parts, ignore_index=True)
    table.insert(0, "mark", mark)
    return table


def _rows(source: str, times_s: Array, values: Array, low: Array, high: Array) -> pd.DataFrame:
    columns = {"time_s": times_s}
    tables = [
        pd.DataFrame(
            {"quantity": name, "source": source} | columns
            | {"value": values[:, k], "ci_low": low[:, k], "ci_high": high[:, k]}
        )
        for k, name in enumerate(MEASURES)
    ]  # fmt: skip
    return pd.concat(tables, ignore_index=True)


def _means(source: str, values: Array, left_out: Array) -> pd.DataFrame:
    low, high = block_band(values, left_out)
    return pd.DataFrame(
        {
            "quantity": MEASURES,
            "source": source,
            "time_s": np.nan,
            "value": values,
            "ci_low": low,
            "ci_high": high,
        }
    )
