# SPDX-License-Identifier: GPL-3.0-or-later
"""Markov test of a model: its chains at several lags against the frames, with bands from blocks of time."""

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bedchain.chains.chain import Chain
from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.modes import Modes, mixing_time, slowest_modes, timescales_s
from bedchain.comparison.forecasts import Sides, Starts, count_starts, counted, propagated
from bedchain.comparison.metrics import Metric, metric
from bedchain.errors import DataError
from bedchain.measures.mixing import GROUPS
from bedchain.trajectory.frames import Frames
from bedchain.uncertainty.bands import (
    BLOCKS,
    FEWEST_CORRELATION_TIMES,
    Array,
    block_band,
    block_edges,
    kept_blocks,
    kept_steps,
)

LOG = logging.getLogger(__name__)

# number of timescales, slowest first; a pair of complex eigenvalues counts twice
TIMESCALES = 5
# a chain of more states gets no longer lags: most pairs would have a single sample, and a lag take a minute
MOST_STATES = 150_000
# steps of the longest lag in a window, at least
FEWEST_STEPS = 5
NONE = np.zeros(0)


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
    further : (..., n) array
        Further numbers that follow from the chain.
    """

    timescales_s: Array
    remaining: Array
    observed: Array
    further: Array


@dataclass(frozen=True)
class Tested:
    """Test of a chain at one lag.

    Parameters
    ----------
    chain : MarkovChain
    modes : Modes
        Its slowest processes.
    whole : MarkovTest
    left_out : MarkovTest
        Of chains learned without each block of time; its arrays have BLOCKS rows, or none in a window too
        short for a band.
    """

    chain: MarkovChain
    modes: Modes
    whole: MarkovTest
    left_out: MarkovTest


def doubled_lags(lag: int, n_frames: int) -> list[int]:
    """Lags ``lag``, ``2 lag``, ``4 lag``, ... that a window holds several steps of [frames]."""
    lags = [lag]
    while 2 * lags[-1] * FEWEST_STEPS < n_frames:
        lags.append(2 * lags[-1])
    return lags


def check_model(
    name: str,
    relearner: Callable[[int], Callable[[NDArray[np.bool_]], Chain]],
    frames: Frames,
    sides: Sides,
    lags: Sequence[int],
    memory: float,
    further: Callable[[MarkovChain], Array],
) -> tuple[list[Metric], Tested]:
    """Implied timescales and Chapman-Kolmogorov test of one model at several lags.

    Parameters
    ----------
    name : str
        Of the model.
    relearner : callable
        From a lag, in frames, to a function that learns the model without some blocks of the frames, such
        as `registry.relearner` gives.
    frames : Frames
        The learning window.
    sides : Sides
        Of the window.
    lags : sequence of int
        Frames in a step.
    memory : float
        Correlation time of the bed [frames].
    further : callable
        Further numbers of the chain of the first lag, (n,).

    Returns
    -------
    rows : list of dict
        implied_timescale (part: 1 the slowest), remaining_propagated by time and group, and by group the
        rms and the mean over the times of its difference from the frames, chapman_kolmogorov_rms and _mean;
        mixing_time at the first lag.
    first : Tested
        At the first lag.
    """
    rows: list[Metric] = []
    first = None
    for lag in lags:
        times = (len(frames.times_s) - lag) / max(memory, lag)
        result = tested(relearner(lag), frames, sides, lag, times, (lambda _: NONE) if first else further)
        lag_s, n_states = lag * frames.interval_s, result.chain.matrix.shape[0]
        rows += result_rows(name, lag_s, sides.gaps[sides.gaps % lag == 0] * frames.interval_s, result)
        if result.modes.dropped.size:
            scales = ", ".join(f"{scale:.3g} s" for scale in timescales_s(result.modes.dropped, lag_s))
            LOG.info("%s chain, lag %g s: dropped processes of few particles, %s", name, lag_s, scales)
        first = first or result
        if n_states > MOST_STATES:
            LOG.info("%s chain: %d states at %g s, no longer lags", name, n_states, lag_s)
            break
    assert first is not None
    return rows + mixing_rows(rows[:1], lags[0] * frames.interval_s), first


def tested(
    relearn: Callable[[NDArray[np.bool_]], Chain],
    frames: Frames,
    sides: Sides,
    lag: int,
    times: float,
    further: Callable[[MarkovChain], Array],
) -> Tested:
    """Test of a chain, and of those without each block where the window holds enough correlation times."""
    n_steps = len(frames.times_s) - lag
    chain = markovian(relearn(np.ones(BLOCKS, bool)))
    starts = count_starts(frames, chain, sides, block_edges(n_steps))
    modes = slowest_modes(chain.matrix, TIMESCALES)
    whole = _result(modes.timescales_s(chain.lag_s), chain, starts, sides, np.ones(BLOCKS, bool), further)
    tests = [whole]
    for kept in kept_blocks() if times >= FEWEST_CORRELATION_TIMES else ():
        again = markovian(relearn(kept))
        scales = timescales_s(modes.again(again.matrix, chain.places_of(again)), chain.lag_s)
        tests.append(_result(scales, again, starts, sides, kept, further))
    names = ("timescales_s", "remaining", "observed", "further")
    left_out = MarkovTest(*(np.stack([getattr(test, name) for test in tests])[1:] for name in names))
    return Tested(chain, modes, whole, left_out)


def _result(
    scales: Array, chain: MarkovChain, starts: Starts, sides: Sides, kept: NDArray[np.bool_],
    further: Callable[[MarkovChain], Array],
) -> MarkovTest:  # fmt: skip
    """Timescales of a chain, and its mixing from all starts beside that of the frames."""
    timescales = np.full(TIMESCALES, np.nan)
    timescales[: scales.size] = scales
    rows, remaining = propagated(chain, starts, sides, kept)
    weights = kept_steps(kept, len(sides.marked) - chain.lag)
    return MarkovTest(timescales, remaining, counted(sides, weights)[rows], further(chain))


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


def result_rows(source: str, lag_s: float, times_s: Array, result: Tested) -> list[Metric]:
    """Rows of a test, with 95 % bands where there are chains without each block."""
    whole, left_out = result.whole, result.left_out
    groups = [group for _, group in GROUPS]
    numbers = [str(number + 1) for number in range(np.isfinite(whole.timescales_s).sum())]
    scales = (whole.timescales_s, left_out.timescales_s)
    rows = _banded("implied_timescale", source, "s", *scales, numbers, "positive")
    for place, time in enumerate(times_s):
        curves = (whole.remaining[place], left_out.remaining[:, place])
        rows += [
            row | {"time_s": time}
            for row in _banded("remaining_propagated", source, "1", *curves, groups, "share")
        ]
    for quantity, summary in (("chapman_kolmogorov_rms", _rms), ("chapman_kolmogorov_mean", _mean)):
        scale = "positive" if summary is _rms else "plain"
        errors = (summary(whole), summary(left_out))
        rows += [
            row | {"time_s": times_s[-1]} for row in _banded(quantity, source, "1", *errors, groups, scale)
        ]
    return [row | {"lag_s": lag_s} for row in rows]


def mixing_rows(slowest: Sequence[Metric], lag_s: float) -> list[Metric]:
    """Mixing time of the slowest process, a row with its band; none without a process."""
    return [
        row
        | {"quantity": "mixing_time", "part": np.nan}
        | {name: mixing_time(row[name], lag_s) for name in ("value", "ci_low", "ci_high")}
        for row in slowest
        if row["quantity"] == "implied_timescale"
    ]


def _rms(result: MarkovTest) -> Array:
    return np.asarray(np.sqrt(((result.remaining - result.observed) ** 2).mean(axis=-2)))


def _mean(result: MarkovTest) -> Array:
    return np.asarray((result.remaining - result.observed).mean(axis=-2))


def _banded(
    quantity: str,
    source: str,
    unit: str,
    values: Array,
    left_out: Array,
    parts: Sequence[str],
    scale: str,
) -> list[Metric]:
    """A row for each part, with the band of the values without each block, (BLOCKS, n_values)."""
    low, high = block_band(values, left_out, scale)
    return [
        metric(quantity, source, value, unit, part=part, ci_low=start, ci_high=end)
        for part, value, start, end in zip(parts, values, low, high, strict=False)
    ]


def counted_rows(sides: Sides, frames: Frames, memory: float) -> list[Metric]:
    """Mixing of the frames, with bands from blocks of starts.

    Parameters
    ----------
    sides : Sides
    frames : Frames
        The same window.
    memory : float
        Correlation time of the bed [frames].

    Returns
    -------
    list of dict
        remaining_counted by time and group.
    """
    n_steps, values = len(frames.times_s) - 1, counted(sides)
    left_out = np.stack([counted(sides, kept_steps(kept, n_steps)) for kept in kept_blocks()])
    low, high = block_band(values, left_out, "share", n_steps / memory)
    return [
        metric("remaining_counted", "dem", share, time_s=gap * frames.interval_s, part=group,
            ci_low=low[place, column], ci_high=high[place, column])
        for place, (gap, shares) in enumerate(zip(sides.gaps, values, strict=True))
        for column, ((_, group), share) in enumerate(zip(GROUPS, shares, strict=True))
    ]  # fmt: skip
