# SPDX-License-Identifier: GPL-3.0-or-later
"""Is the bed Markov for a model? Chains of several lags against the DEM, with bands from blocks of time."""

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bedchain.chains.chain import Chain
from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.matrix_analysis import implied_timescales
from bedchain.comparison.diagnostics import Row, row
from bedchain.comparison.forecasts import Sides, Starts, count_starts, counted, propagated
from bedchain.errors import DataError
from bedchain.measures.mixing import GROUPS
from bedchain.trajectory.frames import Frames
from bedchain.uncertainty.bands import band, block_chains

LOG = logging.getLogger(__name__)

# processes whose timescales are given, slowest first; a pair of complex eigenvalues counts twice
TIMESCALES = 5
# chains learned again for a band, unless learning and solving one takes too long: above these entries
REPLICATES, MOST_ENTRIES = 40, 100_000
# no longer lags for a chain of more states: most pairs are seen once then, and a lag takes a minute
MOST_STATES = 150_000
# windows hold at least this many steps of the longest lag
FEWEST_STEPS = 5


@dataclass(frozen=True)
class Findings:
    """What one chain says, and what the frames do.

    Parameters
    ----------
    timescales_s : (..., n) array
        Slowest first [s]; NaN where there are fewer.
    remaining : (..., n_times, 4) array
        Share of each group on its side by the chain, at whole steps [1].
    observed : (..., n_times, 4) array
        The same by the frames [1].
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
) -> list[Row]:
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
        implied_timescale (part: 1 the slowest), remaining_propagated by time, and over the times
        chapman_kolmogorov_rms and chapman_kolmogorov_mean of its difference from the frames, by group.
    """
    rows = []
    for lag in lags:
        found, replicates, n_states = with_replicates(relearner(lag), frames, sides, lag, block, rng)
        times = sides.gaps[sides.gaps % lag == 0] * frames.interval_s
        rows += finding_rows(name, lag * frames.interval_s, times, found, replicates)
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
) -> tuple[Findings, Findings | None, int]:
    """Findings of a chain, of chains learned again where that is affordable, and its number of states."""
    n_steps = len(frames.times_s) - lag
    one = np.ones(n_steps, np.int64)
    chain = markovian(relearn(one))
    starts = count_starts(frames, chain, sides)
    found = findings(chain, starts, sides, one)
    n_states = chain.matrix.shape[0]
    if chain.matrix.nnz > MOST_ENTRIES:
        return found, None, n_states
    size = found.timescales_s.size
    samples = block_chains(
        lambda weights: findings(markovian(relearn(weights)), starts, sides, weights),
        lambda again: np.concatenate([again.timescales_s, again.remaining.ravel(), again.observed.ravel()]),
        n_steps,
        min(block, n_steps),
        REPLICATES,
        rng,
    )
    curves = samples[:, size:].reshape(len(samples), 2, *found.remaining.shape)
    return found, Findings(samples[:, :size], curves[:, 0], curves[:, 1]), n_states


def markovian(chain: Chain) -> MarkovChain:
    """The chain, if it has a transition matrix.

    Raises
    ------
    DataError
        It has none.
    """
    if not isinstance(chain, MarkovChain):
        raise DataError(f"the {chain.name} model has no transition matrix: take it out of chain.models")
    return chain


def findings(chain: MarkovChain, starts: Starts, sides: Sides, weights: NDArray[np.int64]) -> Findings:
    """Timescales of a chain, and its mixing from all starts beside the frames' own."""
    slowest = np.full(TIMESCALES, np.nan)
    scales = implied_timescales(chain.matrix, chain.lag_s, TIMESCALES)
    slowest[: scales.size] = scales
    which, remaining = propagated(chain, starts, sides, weights)
    return Findings(slowest, remaining, counted(sides, weights)[which])


def finding_rows(
    source: str, lag_s: float, times_s: NDArray[np.float64], found: Findings, replicates: Findings | None
) -> list[Row]:
    """Findings as rows, with 95 % bands where there are replicates."""
    groups = [group for _, group in GROUPS]
    scales = int(np.isfinite(found.timescales_s).sum())
    both = (found, replicates)
    rows = _banded("implied_timescale", source, "s", _slowest, both, [str(n + 1) for n in range(scales)])
    for place, time in enumerate(times_s):
        now = [one and Findings(one.timescales_s, one.remaining[..., place, :], one.observed) for one in both]
        curve = _banded("remaining_propagated", source, "1", lambda one: one.remaining, now, groups)
        rows += [one | {"time_s": time} for one in curve]
    for quantity, of in (("chapman_kolmogorov_rms", _rms), ("chapman_kolmogorov_mean", _mean)):
        rows += [one | {"time_s": times_s[-1]} for one in _banded(quantity, source, "1", of, both, groups)]
    return [one | {"lag_s": lag_s} for one in rows]


def _slowest(found: Findings) -> NDArray[np.float64]:
    return found.timescales_s


def _rms(found: Findings) -> NDArray[np.float64]:
    return np.asarray(np.sqrt(((found.remaining - found.observed) ** 2).mean(axis=-2)))


def _mean(found: Findings) -> NDArray[np.float64]:
    return np.asarray((found.remaining - found.observed).mean(axis=-2))


def _banded(
    quantity: str,
    source: str,
    unit: str,
    of: Callable[[Findings], NDArray[np.float64]],
    both: Sequence[Findings | None],
    parts: Sequence[str],
) -> list[Row]:
    """A quantity of findings, one row a part, with the band of the replicates where there are any."""
    found, replicates = both
    assert found is not None
    ends = np.full((2, len(parts)), np.nan)
    if replicates is not None:
        samples = of(replicates)[:, : len(parts)]
        # an empty group has no band; a chain learned again may have no class that is never left, and then
        # no timescale
        there = np.isfinite(samples).any(axis=0)
        whole = np.isfinite(samples[:, there]).all(axis=1)
        if whole.any():
            ends[:, there] = band(samples[whole][:, there])
    return [
        row(quantity, source, value, unit, part=part, ci_low=float(low), ci_high=float(high))
        for part, value, low, high in zip(parts, of(found), *ends, strict=False)
    ]


def counted_rows(sides: Sides, frames: Frames, block: int, rng: np.random.Generator) -> list[Row]:
    """What the frames show of the mixing, with the band of blocks of starts.

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
        row("remaining_counted", "dem", share, time_s=gap * frames.interval_s, part=group,
            ci_low=float(low[place, column]), ci_high=float(high[place, column]))
        for place, (gap, shares) in enumerate(zip(sides.gaps, counted(sides), strict=True))
        for column, ((_, group), share) in enumerate(zip(GROUPS, shares, strict=True))
    ]  # fmt: skip
