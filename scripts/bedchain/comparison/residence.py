# SPDX-License-Identifier: GPL-3.0-or-later
"""Residence times of an open bed, by the DEM and by a chain, with bands by blocks of time."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.chains.counting import count_moves
from bedchain.chains.open_chain import open_chain
from bedchain.measures.residence import Stays, contents_and_feed, left_share, stays
from bedchain.trajectory.frames import Frames
from bedchain.uncertainty.bands import block_band, block_edges, kept_blocks, kept_steps

Array = NDArray[np.floating]
KINDS = ("mean", "variance", "contents", "throughput", "contents_over_throughput", "held")
UNITS = dict(zip(KINDS, ("s", "s2", "1", "1/s", "s", "1"), strict=True))


class Residence(NamedTuple):
    """Residence times of what enters a bed.

    Attributes
    ----------
    numbers : dict of str to float
        mean [s], variance [s2], contents [1], throughput [1/s], contents over throughput [s]; and held [1],
        the share that was not seen to leave.
    left : (n_times,) array
        F: share that has left after each time [1].
    """

    numbers: dict[str, float]
    left: Array


def of_chain(frames: Frames, n_cells: int, lag: int, steps: int) -> Callable[[NDArray[np.bool_]], Residence]:
    """Residence times of the chain learned from the blocks of a window that are kept.

    Parameters
    ----------
    frames : Frames
        The learning window.
    n_cells : int
    lag : int
        Frames in a step.
    steps : int
        Steps after entering at which F is given, from 0 on.

    Returns
    -------
    callable
        From the blocks that are kept, (BLOCKS,) bools, to the `Residence`.
    """
    edges = block_edges(len(frames.times_s) - lag)
    lag_s = lag * frames.interval_s
    blocks = zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True)
    parts = [count_moves(frames.cells, n_cells, lag, first, last) for first, last in blocks]

    def learned(kept: NDArray[np.bool_]) -> Residence:
        chain = open_chain([part for part, is_kept in zip(parts, kept, strict=True) if is_kept], lag_s)
        mean, variance = chain.residence()
        contents, throughput = float(chain.hold_up().sum()), chain.throughput / lag_s
        held = float(chain.exit_shares()[1])
        values = (mean, variance, contents, throughput, contents / throughput, held)
        return Residence(dict(zip(KINDS, values, strict=True)), chain.left_by(steps).sum(axis=1))

    return learned


def of_dem(frames: Frames, times_s: Array) -> Callable[[NDArray[np.bool_]], Residence]:
    """Residence times that were seen in the blocks of a window that are kept.

    A stay belongs to the block in which it begins. Mean and variance are those of F up to the longest stay;
    what is still inside then is held.

    Parameters
    ----------
    frames : Frames
        The window.
    times_s : (n_times,) array
        Rising times after entering at which F is given [s].

    Returns
    -------
    callable
        From the blocks that are kept, (BLOCKS,) bools, to the `Residence`.
    """
    present = np.asarray(frames.cells) >= 0
    n_steps, interval = len(present) - 1, frames.interval_s
    (contents, feed), observed = contents_and_feed(present), stays(present)

    def seen(kept: NDArray[np.bool_]) -> Residence:
        weights = kept_steps(kept, n_steps)
        of_kept = observed.of(weights[observed.entered - 1] > 0)
        held, rate = weights @ contents / weights.sum(), weights @ feed / weights.sum() / interval
        mean, variance, inside = _moments(of_kept, interval)
        values = (mean, variance, held, rate, held / rate, inside)
        numbers = {name: float(value) for name, value in zip(KINDS, values, strict=True)}
        return Residence(numbers, left_share(of_kept, interval, times_s))

    return seen


def _moments(observed: Stays, interval_s: float) -> tuple[float, float, float]:
    """Mean [s] and variance [s2] of stays up to the longest, and the share that is still inside then [1]."""
    longest = int(observed.frames.max())
    left = left_share(observed, interval_s, interval_s * np.arange(longest + 1))
    inside = 1 - left
    # E[T] = sum of the share inside, E[T^2] = sum of (2 k + 1) times it, in intervals
    mean, square = inside[:-1].sum(), ((2 * np.arange(longest) + 1) * inside[:-1]).sum()
    return interval_s * mean, interval_s**2 * (square - mean**2), float(inside[-1])


def residence_table(
    source: str, times_s: Array, of: Callable[[NDArray[np.bool_]], Residence]
) -> pd.DataFrame:
    """Table of residence times with bands: F and E over time, and their numbers.

    Parameters
    ----------
    source : str
    times_s : (n_times,) array
        Evenly spaced times after entering, from 0 on [s].
    of : callable
        `of_chain` or `of_dem`.

    Returns
    -------
    DataFrame
        quantity, source, time_s, value, unit, ci_low, ci_high; ``left_share`` is F, ``leaving_rate`` E.
    """
    blocks = kept_blocks()
    whole, parts = of(np.ones(len(blocks), bool)), [of(kept) for kept in blocks]
    rows = []
    for name in KINDS:
        scale = "share" if name == "held" else "positive"
        left_out = np.array([part.numbers[name] for part in parts])
        low, high = block_band(whole.numbers[name], left_out, scale)
        rows.append((name, source, np.nan, whole.numbers[name], UNITS[name], float(low), float(high)))
    step_s = times_s[1] - times_s[0]
    curves = np.stack([whole.left, *(part.left for part in parts)])
    rates = np.diff(curves, axis=1) / step_s
    low, high = block_band(curves[0], curves[1:], "share")
    rows += [
        ("left_share", source, *row)
        for row in zip(times_s, curves[0], ["1"] * len(low), low, high, strict=True)
    ]
    low, high = block_band(rates[0], rates[1:])
    middles, unit = times_s[1:] - step_s / 2, ["1/s"] * len(low)
    rows += [("leaving_rate", source, *row) for row in zip(middles, rates[0], unit, low, high, strict=True)]
    return pd.DataFrame(rows, columns=["quantity", "source", "time_s", "value", "unit", "ci_low", "ci_high"])
