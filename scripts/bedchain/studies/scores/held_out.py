# SPDX-License-Identifier: GPL-3.0-or-later
"""Held-out data: mixing curves and batches of the DEM after the learning window, of all starts and runs."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bedchain.measures.batch import batch_of, share_by_cell
from bedchain.measures.mixing import Splits
from bedchain.studies.marked_starts import Start, starts_in
from bedchain.studies.scan import REPLICATES, observed_curves
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import Realisation, part_of
from bedchain.uncertainty.deviations import deviations, distances, mean_of_others, resampled, stacked

Array = NDArray[np.float64]

# of the intervals only: the same data give the same interval
INTERVAL_SEED = 17


@dataclass(frozen=True)
class HeldOut:
    """Curves and batches of the DEM after the learning window, in the run learned from and in its repeats.

    Parameters
    ----------
    runs : sequence of Realisation
        First the run learned from.
    starts : sequence of Start
        In all runs.
    grid : Grid
        The case's cells, for the batch.
    curves : (n_starts, n_frames, 4) array
        Mixing curves, NaN after a start's last frame [1].
    batches : sequence of (n_particles,) bool array
        Particles low in the bed at each start.
    moments : (n_moments,) int array
        Frames after a start at which the batch is recorded [1].
    densities : (n_starts, n_moments, n_cells) array
        Share of the batch in each cell, NaN after a start's last frame [1].
    """

    runs: Sequence[Realisation]
    starts: Sequence[Start]
    grid: Grid
    curves: Array
    batches: Sequence[NDArray[np.bool_]]
    moments: NDArray[np.int64]
    densities: Array

    @property
    def interval_s(self) -> float:
        """Time between two frames [s]."""
        return self.runs[0].interval_s

    @property
    def run_of_start(self) -> NDArray[np.int64]:
        """Number of the run of each start, (n_starts,)."""
        return np.array([start.run for start in self.starts])

    @property
    def number_in_window(self) -> NDArray[np.int64]:
        """Number of each start in its window, (n_starts,)."""
        return np.array([start.number for start in self.starts])

    @property
    def repeated(self) -> bool:
        """Whether the noise floor is the spread of repeats; without repeats it is that of starts."""
        return len(self.runs) > 1

    def windows(self) -> dict[str, NDArray[np.bool_]]:
        """Starts over which each score is taken, as masks by the name of the window.

        ``start``: the paper's single start. ``starts``: all starts of all runs. ``repeats``: the paper's
        start in each repeat, from which no chain was learned.
        """
        first = self.number_in_window == 0
        masks = {"start": first & (self.run_of_start == 0), "starts": np.ones(first.size, bool)}
        return masks | ({"repeats": first & (self.run_of_start > 0)} if self.repeated else {})

    def floor_of(self, window: str) -> NDArray[np.bool_]:
        """Starts whose spread is the noise floor of a window."""
        all_of_them = window == "starts" or not self.repeated
        return np.ones(len(self.starts), bool) if all_of_them else self.number_in_window == 0

    def deviations(self) -> Array:
        """Deviations of each curve from the mean of its repeats (`deviations.deviations`)."""
        return deviations(self.curves, self._group())

    def deviations_of_starts(self) -> Array:
        """Deviations of each curve from the mean of the other starts in its run, whose state differs too.

        This is the error of a model that knows the mean of all states, but not the bubbles at the start.
        """
        return deviations(self.curves, self.run_of_start)

    def batch_distances(self) -> Array:
        """Total variation of each batch from the mean of its repeats, (n_starts, n_moments, 1) [1]."""
        return distances(self.densities, mean_of_others(self.densities, self._group()))

    def weights(self, which: NDArray[np.bool_]) -> Array:
        """Bootstrap weights of the starts for intervals, (n_replicates, n_which)."""
        return resampled(self.run_of_start[which], REPLICATES, np.random.default_rng(INTERVAL_SEED))

    def _group(self) -> NDArray[np.int64]:
        return self.number_in_window if self.repeated else np.zeros(len(self.starts), np.int64)


def hold_out(
    runs: Sequence[Realisation], grid: Grid, comparison_s: tuple[float, float], spacing: int,
    splits: Splits, batch_height_m: float, moments_s: Sequence[float],
) -> HeldOut:  # fmt: skip
    """Curves and batches of the DEM in the comparison window of each run.

    Parameters
    ----------
    runs : sequence of Realisation
        First the run learned from.
    grid : Grid
        The case's cells.
    comparison_s : (float, float)
        Start and end of the comparison window [s].
    spacing : int
        Frames between starts.
    splits : Splits
    batch_height_m : float
        Height of the batch [m].
    moments_s : sequence of float
        Times after each start at which the batch is recorded [s].

    Returns
    -------
    HeldOut

    Raises
    ------
    UserError
        A run lacks more than half of the window.
    """
    starts = [
        start
        for number, run in enumerate(runs)
        for start in starts_in(part_of(run, *comparison_s), spacing, number)
    ]
    moments = np.array([round(moment / runs[0].interval_s) for moment in moments_s], np.int64)
    batches, densities = [], []
    for start in starts:
        run = runs[start.run]
        batches.append(batch_of(grid, _cells(run, grid, start.frame), batch_height_m))
        shares = np.full((moments.size, grid.n_cells), np.nan)
        for row, moment in zip(shares, moments, strict=True):
            if moment <= start.length:
                row[:] = share_by_cell(_cells(run, grid, start.frame + moment)[batches[-1]], grid.n_cells)
        densities.append(shares)
    curves = stacked([observed_curves(runs[start.run], start, splits) for start in starts])
    return HeldOut(runs, starts, grid, curves, batches, moments, np.array(densities))


def _cells(run: Realisation, grid: Grid, frame: int) -> NDArray[np.int32]:
    return grid.cell_of(run.values[frame, 0], run.values[frame, 1])
