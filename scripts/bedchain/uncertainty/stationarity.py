# SPDX-License-Identifier: GPL-3.0-or-later
"""Stationarity of a bed: drifts of its series, with intervals from moving blocks."""

from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import special

from bedchain.uncertainty.bands import correlation_steps

LEVEL = 0.95
# length of a block in correlation times, and least number of blocks in a series
BLOCK_CORRELATIONS, FEWEST_BLOCKS = 3, 5
REPLICATES = 1000
# seed of the intervals: the same series gives the same interval
SEED = 13


class Drift(NamedTuple):
    """Straight line through a series.

    Attributes
    ----------
    mean : float
        Of the series, in its unit.
    change : float
        Of the line from the first to the last time, in its unit.
    low, high : float
        Ends of the interval of the change.
    block : int
        Steps in a block.
    """

    mean: float
    change: float
    low: float
    high: float
    block: int

    @property
    def stationary(self) -> bool:
        """True if the interval holds 0: a steady bed may change as much by chance."""
        return self.low <= 0 <= self.high


def drift(series: NDArray[np.floating], level: float = LEVEL) -> Drift:
    """Drift of an evenly spaced series, by least squares, with the interval of moving blocks.

    The residuals of the line are resampled in blocks of three correlation times (Kuensch 1989), at most a
    fifth of the series. A line is fitted to each resampled series: its change is due to chance alone.

    Parameters
    ----------
    series : (n_times,) array
        At least ten times.
    level : float
        Of the interval [1].

    Returns
    -------
    Drift
    """
    values = np.asarray(series, float)
    line = np.linspace(-0.5, 0.5, len(values))
    weights = line / (line @ line)
    change = float(weights @ values)
    rest = values - values.mean() - change * line
    longest = max(1, len(rest) // FEWEST_BLOCKS)
    block = int(np.clip(BLOCK_CORRELATIONS * correlation_steps(rest), 1, longest))
    rng = np.random.default_rng(SEED)
    n_blocks = -(-len(rest) // block)
    first = rng.integers(0, len(rest) - block + 1, (REPLICATES, n_blocks))
    drawn = (first[:, :, None] + np.arange(block)).reshape(REPLICATES, -1)[:, : len(rest)]
    noise = rest[drawn] @ weights
    # few blocks: the line takes two degrees of freedom, and the spread is itself uncertain (Student)
    free = n_blocks - 2
    quantile = (1 + level) / 2
    noise *= np.sqrt(n_blocks / free) * special.stdtrit(free, quantile) / special.ndtri(quantile)
    low, high = np.quantile(noise, [(1 - level) / 2, (1 + level) / 2])
    return Drift(float(values.mean()), change, change - float(high), change - float(low), block)


def drift_table(
    series: dict[str, tuple[str, float, NDArray[np.floating]]],
    profile: NDArray[np.float64],
    heights_m: NDArray[np.float64],
    interval_s: float,
) -> pd.DataFrame:
    """Drifts of all series and of the voidage in each row.

    Parameters
    ----------
    series : dict of str to (unit, interval [s], values)
        By quantity.
    profile : (n_frames, n_rows) array
        Voidage [1]; rows without any particle are left out. Each row has the level 1 - 0.05 / n_rows, so
        that 5 % of steady beds have a row that is not stationary by chance.
    heights_m : (n_rows,) array
        Centres of the rows [m].
    interval_s : float
        Between the frames of the profile [s].

    Returns
    -------
    DataFrame
        quantity, height_m (rows of the profile only), mean, drift, ci_low, ci_high, unit, block_s,
        stationary_1 (1 or 0).
    """
    rows = [_row(name, np.nan, drift(values), unit, step) for name, (unit, step, values) in series.items()]
    held = np.flatnonzero(profile.min(axis=0) < 1)
    level = 1 - (1 - LEVEL) / max(len(held), 1)
    rows += [_row("voidage", heights_m[row], drift(profile[:, row], level), "1", interval_s) for row in held]
    return pd.DataFrame(rows)


def _row(quantity: str, height_m: float, line: Drift, unit: str, step_s: float) -> dict[str, object]:
    return {
        "quantity": quantity, "height_m": height_m, "mean": line.mean, "drift": line.change,
        "ci_low": line.low, "ci_high": line.high, "unit": unit, "block_s": line.block * step_s,
        "stationary_1": int(line.stationary),
    }  # fmt: skip
