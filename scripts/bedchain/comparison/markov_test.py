# SPDX-License-Identifier: GPL-3.0-or-later
"""Markov test of a model: its chains at several lags against the frames, with bands from blocks of time."""

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bedchain.chains.chain import Chain
from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.matrix_analysis import implied_timescales
from bedchain.comparison.forecasts import Sides, Starts, count_starts, counted, propagated
from bedchain.comparison.metrics import Metric, metric
from bedchain.errors import DataError
from bedchain.measures.mixing import GROUPS
from bedchain.trajectory.frames import Frames
from bedchain.uncertainty.bands import band, block_chains

LOG = logging.getLogger(__name__)

# number of timescales, slowest first; a pair of complex eigenvalues counts twice
TIMESCALES = 5
# replicates of a chain for a band; none for a matrix of more entries, which takes too long to learn and solve
REPLICATES, MOST_ENTRIES = 40, 100_000
# a chain of more states gets no longer lags: most pairs would have a single sample, and a lag take a minute
MOST_STATES = 150_000
# steps of the longest lag in a window, at least
FEWEST_STEPS = 5


@dataclass(frozen=True)
class MarkovTest:
    """Timescales and mixing of a chain, beside the mixing of the frames.

    Parameters
    ----------
    timescales_s : (..., n) array
        Slowest first [s]; NaN beyond the last.
    remaining : (..., n_times, 4) array
        Share of each group on its side, by the chain at whole steps [1].
    observed : (..., n_times, 4) array
        The same, by the frames [1].
    """

    timescales_s: NDArray[np.float64]
    remaining: NDArray[np.float64]
    observed: NDArray[np.float64]


def doubled_lags(lag: int, n_frames: int) -> list[int]:
    """Lags ``lag``, ``2 lag``, ``4 lag``, ... that a window holds several steps of [frames]."""
    lags = [lag]
    while 2 * lags[-1] * FEWEST_STEPS < n_frames:
        lags.append(2 * lags[-1])
    return lags


def check_model(
    name: str,
    relearner: Callable[[int], Callable[[NDArray[np.int64]], Chain]],
    frames: Frames,
    sides: Sides,
    lags: Sequence[int],
    block: int,
    rng: np.random.Generator,
) -> list[Metric]:
    """Implied timescales and Chapman-Kolmogorov test of one model at several lags.

    Parameters
    ----------
    name : str
        Of the model.
    relearner : callable
        From a lag, in frames, to a function that learns the model on weighted steps of the frames, such as
        `registry.relearner` gives.
    frames : Frames
        The learning window.
    sides : Sides
        Of the window.
    lags : sequence of int
        Frames in a step.
    block : int
        Frames in a block of the bootstrap.
    rng : numpy Generator
        Draws the blocks.

    Returns
    -------
    list of dict
        implied_timescale (part: 1 the slowest), remaining_propagated by time and group, and by group the
        rms and the mean over the times of its difference from the frames, chapman_kolmogorov_rms and _mean.
    """
    rows = []
    for lag in lags:
        result, replicates, n_states = with_replicates(relearner(lag), frames, sides, lag, block, rng)
        times = sides.gaps[sides.gaps % lag == 0] * frames.interval_s
        rows += result_rows(name, lag * frames.interval_s, times, result, replicates)
        if n_states > MOST_STATES:
            LOG.info("%s chain: %d states at %g s, no longer lags", name, n_states, lag * frames.interval_s)
            break
    return rows


def with_replicates(
    relearn: Callable[[NDArray[np.int64]], Chain],
    frames: Frames,
    sides: Sides,
    lag: int,
    block: int,
    rng: np.random.Generator,
) -> tuple[MarkovTest, MarkovTest, int]:
    """Test of a chain, its replicates (none where they take too long), and the chain's number of states."""
    n_steps = len(frames.times_s) - lag
    every_step = np.ones(n_steps, np.int64)
    chain = markovian(relearn(every_step))
    starts = count_starts(frames, chain, sides)
    result = tested(chain, starts, sides, every_step)
    if chain.matrix.nnz > MOST_ENTRIES:
        samples = np.empty((0, _flat(result).size))
    else:
        samples = block_chains(
            lambda weights: tested(markovian(relearn(weights)), starts, sides, weights),
            _flat,
            n_steps,
            min(block, n_steps),
            REPLICATES,
            rng,
        )
    n_scales = result.timescales_s.size
    curves = samples[:, n_scales:].reshape(len(samples), 2, *result.remaining.shape)
    return result, MarkovTest(samples[:, :n_scales], curves[:, 0], curves[:, 1]), chain.matrix.shape[0]


def _flat(result: MarkovTest) -> NDArray[np.float64]:
    return np.concatenate([result.timescales_s, result.remaining.ravel(), result.observed.ravel()])


def markovian(chain: Chain) -> MarkovChain:
    """The same chain, checked to have a transition matrix.

    Raises
    ------
    DataError
        It has none.
    """
    if not isinstance(chain, MarkovChain):
        raise DataError(f"the {chain.name} model has no transition matrix: take it out of chain.models")
    return chain


def tested(chain: MarkovChain, starts: Starts, sides: Sides, weights: NDArray[np.int64]) -> MarkovTest:
    """Timescales of a chain, and its mixing from all starts beside that of the frames."""
    timescales = np.full(TIMESCALES, np.nan)
    slowest = implied_timescales(chain.matrix, chain.lag_s, TIMESCALES)
    timescales[: slowest.size] = slowest
    rows, remaining = propagated(chain, starts, sides, weights)
    return MarkovTest(timescales, remaining, counted(sides, weights)[rows])


def result_rows(
    source: str, lag_s: float, times_s: NDArray[np.float64], result: MarkovTest, replicates: MarkovTest
) -> list[Metric]:
    """Rows of a test, with 95 % bands if there are replicates."""
    groups = [group for _, group in GROUPS]
    numbers = [str(number + 1) for number in range(np.isfinite(result.timescales_s).sum())]
    rows = _banded("implied_timescale", source, "s", result.timescales_s, replicates.timescales_s, numbers)
    for place, time in enumerate(times_s):
        curves = (result.remaining[place], replicates.remaining[:, place])
        rows += [
            row | {"time_s": time} for row in _banded("remaining_propagated", source, "1", *curves, groups)
        ]
    for quantity, summary in (("chapman_kolmogorov_rms", _rms), ("chapman_kolmogorov_mean", _mean)):
        errors = (summary(result), summary(replicates))
        rows += [row | {"time_s": times_s[-1]} for row in _banded(quantity, source, "1", *errors, groups)]
    return [row | {"lag_s": lag_s} for row in rows]


def _rms(result: MarkovTest) -> NDArray[np.float64]:
    return np.asarray(np.sqrt(((result.remaining - result.observed) ** 2).mean(axis=-2)))


def _mean(result: MarkovTest) -> NDArray[np.float64]:
    return np.asarray((result.remaining - result.observed).mean(axis=-2))


def _banded(
    quantity: str,
    source: str,
    unit: str,
    values: NDArray[np.float64],
    samples: NDArray[np.float64],
    parts: Sequence[str],
) -> list[Metric]:
    """A row for each part, with the band of the samples, (n_replicates, n_values), if there are any."""
    samples = samples[:, : len(parts)]
    low, high = ends = np.full((2, len(parts)), np.nan)
    # an empty group has no band; a replicate without a closed class has no timescales
    there = np.isfinite(samples).any(axis=0)
    whole = np.isfinite(samples[:, there]).all(axis=1)
    if whole.any():
        ends[:, there] = band(samples[whole][:, there])
    return [
        metric(quantity, source, value, unit, part=part, ci_low=start, ci_high=end)
        for part, value, start, end in zip(parts, values, low, high, strict=False)
    ]


def counted_rows(sides: Sides, frames: Frames, block: int, rng: np.random.Generator) -> list[Metric]:
    """Mixing of the frames, with bands from blocks of starts.

    Parameters
    ----------
    sides : Sides
    frames : Frames
        The same window.
    block : int
        Frames in a block.
    rng : numpy Generator
        Draws the blocks.

    Returns
    -------
    list of dict
        remaining_counted by time and group.
    """
    n_steps = len(frames.times_s) - 1
    samples = block_chains(
        lambda weights: weights, lambda weights: counted(sides, weights), n_steps, block, REPLICATES, rng
    )
    low, high = band(samples)
    return [
        metric("remaining_counted", "dem", share, time_s=gap * frames.interval_s, part=group,
            ci_low=low[place, column], ci_high=high[place, column])
        for place, (gap, shares) in enumerate(zip(sides.gaps, counted(sides), strict=True))
        for column, ((_, group), share) in enumerate(zip(GROUPS, shares, strict=True))
    ]  # fmt: skip
