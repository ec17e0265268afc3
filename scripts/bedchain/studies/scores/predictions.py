# SPDX-License-Identifier: GPL-3.0-or-later
"""Predictions of a chain for the held-out data, after learning on the whole learning window."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bedchain.chains.between_steps import learn_fractions
from bedchain.chains.chain import Chain
from bedchain.measures.lagrangian import Places, Statistics, corrected, in_cells, statistics
from bedchain.studies.candidates import Candidate, grid_of
from bedchain.studies.marked_starts import Start
from bedchain.studies.scan import Task, at_frames, learned, predicted_curves, running_cost, timed
from bedchain.studies.scores.held_out import HeldOut
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.regrid import regrid
from bedchain.uncertainty.deviations import stacked

Array = NDArray[np.float64]

# times after a start at which mixing curves are scored [s]
TIMES_S = (0.1, 0.25, 0.5, 1.0, 2.0, 5.0)
# time of the displacements of autocorrelation and dispersion [s]; over shorter times cells hide them
SPAN_S = 0.1
# number of times of the mean-square displacement, evenly spaced in their logarithms
LAGRANGIAN_TIMES = 24
# rows of the case's cells in a layer of the dispersion, so that cells twice as large fit in a layer
LAYER_ROWS = 2


@dataclass(frozen=True)
class Predictions:
    """A chain and its predictions for the held-out data.

    Parameters
    ----------
    chain : Chain
    lag : int
        Frames in its step.
    curves : (n_starts, n_frames, 4) array
        Expected mixing curves at every frame from each start of the `HeldOut` [1].
    densities : (n_starts, n_moments, n_cells) array
        Expected shares of the batch, on the case's cells [1].
    drawn : (n_starts, n_frames, 4) array
        Mixing curves of one Monte Carlo from each start [1].
    lagrangian : list of (model, dem) Statistics
        Of each run, from the start of the window.
    cost_s : dict of str to float
        learn_s, and those of `scan.running_cost` [s].
    """

    chain: Chain
    lag: int
    curves: Array
    densities: Array
    drawn: Array
    lagrangian: list[tuple[Statistics, Statistics]]
    cost_s: dict[str, float]


def predict_held_out(
    candidate: Candidate, learning: slice, held: HeldOut, task: Task, seed: int
) -> Predictions:
    """Learn a candidate on the whole learning window and run it from every held-out start.

    Parameters
    ----------
    candidate : Candidate
        With its chosen settings.
    learning : slice
        Frames of the learning window of the first run.
    held : HeldOut
    task : Task
    seed : int
        Of the Monte Carlo runs.

    Returns
    -------
    Predictions

    Raises
    ------
    DataError
        The model cannot use the data.
    """
    run, lag = held.runs[0], candidate.lag
    grid = grid_of(candidate, task.grid)
    frames = run.frames(grid, learning)
    chain, learn_s = timed(lambda: learned(candidate, frames, task))
    fractions = learn_fractions(frames, grid.n_cells, lag, task.estimator)
    rng = np.random.default_rng(seed)
    curves, densities, drawn = [], [], []
    for start, batch in zip(held.starts, held.batches, strict=True):
        begin = held.runs[start.run].leading_to(chain.grid, start.frame, lag)
        curves.append(predicted_curves(chain, held.runs[start.run], start, lag, task.splits, fractions))
        inside = held.moments[held.moments <= start.length]
        shares = batch_shares(chain, begin, batch, inside, lag)
        densities.append(regrid(shares, chain.grid, held.grid))
        monte_carlo = chain.mixing(begin, *task.splits, -(-start.length // lag), rng)
        drawn.append(at_frames(monte_carlo, lag, start.length))
    lagrangian = [lagrangian_of(chain, held, number, lag, rng) for number in range(len(held.runs))]
    first = run.leading_to(grid, held.starts[0].frame, lag)
    cost = {"learn_s": learn_s} | running_cost(chain, first, task)
    return Predictions(
        chain, lag, stacked(curves), _padded(densities, held), stacked(drawn), lagrangian, cost
    )


def batch_shares(
    chain: Chain,
    begin: Frames,
    batch: NDArray[np.bool_],
    moments: NDArray[np.int64],
    lag: int,
    rng: np.random.Generator | None = None,
) -> Array:
    """Shares of a batch in a chain's cells at given frames, interpolated linearly between its steps.

    Parameters
    ----------
    chain : Chain
    begin : Frames
        Frames up to the start.
    batch : (n_particles,) bool array
    moments : (n_moments,) int array
        Rising frames after the start [1].
    lag : int
        Frames in a step.
    rng : numpy Generator, optional
        For a Monte Carlo of every particle instead of the expectation.

    Returns
    -------
    (n_moments, n_cells) array
        Shares of the batch [1].
    """
    if moments.size == 0:
        return np.zeros((0, chain.grid.n_cells))
    before, after = moments // lag, -(-moments // lag)
    steps = np.unique(np.concatenate((before, after)))
    shares = chain.densities(begin, batch[None], [int(step) for step in steps], rng)[:, 0] / batch.sum()
    part = (moments / lag - before)[:, None]
    first, last = (shares[np.searchsorted(steps, end)] for end in (before, after))
    return np.asarray((1 - part) * first + part * last)


def lagrangian_of(
    chain: Chain, held: HeldOut, number: int, lag: int, rng: np.random.Generator
) -> tuple[Statistics, Statistics]:
    """Lagrangian statistics of a chain's particles and of the DEM's, from the window's start to its end.

    Parameters
    ----------
    chain : Chain
    held : HeldOut
    number : int
        Of the run.
    lag : int
        Frames in a step.
    rng : numpy Generator

    Returns
    -------
    model, dem : Statistics
        At the same times, multiples of the lag; the model's corrected for the size of its cells.
    """
    dem, values, steps, span, edges = _dem_statistics(held, number, lag)
    interval_s = lag * held.interval_s
    seen = np.stack([chain.grid.cell_of(now[0], now[1]) for now in values])
    dem_in_cells = statistics(in_cells(chain.grid, seen, interval_s), steps, span, edges)
    start = _first_start(held, number)
    begin = held.runs[number].leading_to(chain.grid, start.frame, lag)
    cells = np.stack([*chain.paths(begin, len(values) - 1, rng)])
    model = statistics(in_cells(chain.grid, cells, interval_s), steps, span, edges)
    return corrected(model, dem, dem_in_cells), dem


def dem_statistics(held: HeldOut, number: int, lag: int = 1) -> Statistics:
    """Lagrangian statistics of the DEM's particles in the window of a run, at every ``lag`` frames."""
    return _dem_statistics(held, number, lag)[0]


def _dem_statistics(
    held: HeldOut, number: int, lag: int
) -> tuple[Statistics, NDArray[np.floating], NDArray[np.int64], int, Array]:
    start = _first_start(held, number)
    count = start.length // lag
    values = held.runs[number].values[start.frame : start.frame + count * lag + 1 : lag]
    interval_s = lag * held.interval_s
    span = max(1, round(SPAN_S / interval_s))
    longest = max(1, min(count // 2, count - span))
    wanted = np.concatenate((np.geomspace(1, longest, LAGRANGIAN_TIMES), np.array(TIMES_S) / interval_s))
    steps = np.unique(np.concatenate(([0], wanted[wanted <= longest].round().astype(int))))
    edges = np.append(held.grid.z_edges_m[:-1:LAYER_ROWS], held.grid.height_m)
    places = Places(values[:, 0], values[:, 1], interval_s)
    return statistics(places, steps, span, edges), values, steps, span, edges


def _first_start(held: HeldOut, number: int) -> Start:
    return next(start for start in held.starts if start.run == number)


def _padded(densities: list[Array], held: HeldOut) -> Array:
    table = np.full(held.densities.shape, np.nan)
    for row, shares in zip(table, densities, strict=True):
        row[: len(shares)] = shares
    return table
