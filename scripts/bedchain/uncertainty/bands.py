# SPDX-License-Identifier: GPL-3.0-or-later
"""Error bars from moving blocks of time.

Particles of a bubble move together, and successive frames are similar: the binomial error of as many
independent particles is far too small. Instead whole blocks of steps are resampled (Kuensch 1989), longer
than the correlation time of the bed.
"""

from collections.abc import Callable
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from bedchain.errors import DataError
from bedchain.trajectory.frames import Frames

Learned = TypeVar("Learned")


def block_weights(n_steps: int, block: int, rng: np.random.Generator) -> NDArray[np.int64]:
    """Weight of each step in a replicate: blocks are drawn with replacement, the last is cut to fit.

    Parameters
    ----------
    n_steps : int
        Steps in the window.
    block : int
        Steps in a block; several blocks must fit into the window for a meaningful band.
    rng : numpy Generator
        Draws the first steps of the blocks.

    Returns
    -------
    (n_steps,) int64 array
        Number of times that each step counts; sums to ``n_steps``.

    Raises
    ------
    DataError
        The block is empty or longer than the window.
    """
    if not 1 <= block <= n_steps:
        raise DataError(
            f"blocks of {block} steps do not fit a window of {n_steps} steps: take 1 to {n_steps // 5 or 1}"
        )
    n_blocks = -(-n_steps // block)
    first = rng.integers(0, n_steps - block + 1, n_blocks)
    steps = (first[:, None] + np.arange(block)).ravel()[:n_steps]
    return np.bincount(steps, minlength=n_steps).astype(np.int64)


def block_means(
    series: NDArray[np.floating], block: int, replicates: int, rng: np.random.Generator
) -> NDArray[np.float64]:
    """Means over time of a series that is resampled by blocks.

    Parameters
    ----------
    series : (n_steps, ...) array
        Values at each step: densities, or mixing curves by their first step.
    block : int
        Steps in a block.
    replicates : int
        Number of means.
    rng : numpy Generator
        Draws the blocks.

    Returns
    -------
    (replicates, ...) array
    """
    flat = np.asarray(series, float).reshape(len(series), -1)
    means = np.empty((replicates, flat.shape[1]))
    for replicate in range(replicates):
        means[replicate] = block_weights(len(series), block, rng) @ flat / len(series)
    return means.reshape(replicates, *series.shape[1:])


def block_chains(
    learn: Callable[[NDArray[np.int64]], Learned],
    evaluate: Callable[[Learned], NDArray[np.float64]],
    n_steps: int,
    block: int,
    replicates: int,
    rng: np.random.Generator,
) -> NDArray[np.float64]:
    """Results of chains learned from resampled blocks of the learning window.

    Parameters
    ----------
    learn : callable
        From step weights, (n_steps,), to a chain: `registry.learn` with ``step_weights``.
    evaluate : callable
        From a chain to an array, always of the same shape: mixing curves, a density.
    n_steps : int
        Steps that start in the learning window, ``n_frames - lag``.
    block : int
        Steps in a block.
    replicates : int
        Chains to learn.
    rng : numpy Generator
        Draws the blocks.

    Returns
    -------
    (replicates, ...) array
    """
    return np.stack([evaluate(learn(block_weights(n_steps, block, rng))) for _ in range(replicates)])


def band(
    samples: NDArray[np.float64], level: float = 0.95
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Ends of the central interval of the replicates (percentile band).

    Parameters
    ----------
    samples : (replicates, ...) array
        From `block_means` or `block_chains`.
    level : float
        Share of the replicates inside [1].

    Returns
    -------
    low, high : (...) array
    """
    low, high = np.quantile(samples, [(1 - level) / 2, (1 + level) / 2], axis=0)
    return low, high


def correlation_steps(series: NDArray[np.floating]) -> float:
    """Integrated autocorrelation time of a series, ``1 + 2 sum(rho)`` up to the first rho below 0 [steps].

    Parameters
    ----------
    series : (n_steps,) array
        Such as the share of the particles in the left half, or the height of their centre of mass.

    Returns
    -------
    float
        At least 1; blocks should be several times as long.
    """
    if np.ptp(series) == 0:
        return 1.0  # and not what round-off of the mean leaves
    centred = np.asarray(series, float) - np.mean(series)
    power = float(centred @ centred)
    size = 2 * len(centred)
    spectrum = np.abs(np.fft.rfft(centred, size)) ** 2
    rho = np.fft.irfft(spectrum, size)[: len(centred)] / power
    below = np.flatnonzero(rho < 0)
    end = int(below[0]) if below.size else len(rho)
    return max(1.0, 1.0 + 2.0 * float(rho[1:end].sum()))


def block_steps(correlation: float, n_steps: int) -> int:
    """Steps in a block: several correlation times, but at least `FEWEST_BLOCKS` blocks in the window.

    Parameters
    ----------
    correlation : float
        `correlation_steps` of what is observed [steps].
    n_steps : int
        Steps in the window.
    """
    return int(np.clip(BLOCK_CORRELATIONS * correlation, 1, max(1, n_steps // FEWEST_BLOCKS)))


def block_length(frames: Frames, split_x_m: float, lag: int) -> int:
    """Steps in a block for a window of frames: `block_steps` of the longer of `memory` and a lag.

    Parameters
    ----------
    frames : Frames
        The learning window.
    split_x_m : float
        Line between left and right [m].
    lag : int
        Frames in a step of the chain.

    Returns
    -------
    int
        Steps.
    """
    return block_steps(max(memory(frames, split_x_m), lag), len(frames.times_s) - lag)


# length of a block in correlation times, and least number of blocks in a window
BLOCK_CORRELATIONS, FEWEST_BLOCKS = 3, 5


REPLICATES = 400


# seed of the bands: the same data give the same band
BAND_SEED = 11


def memory(frames: Frames, split_x_m: float) -> float:
    """Correlation time of the bed [frames].

    Parameters
    ----------
    frames : Frames
        The learning window.
    split_x_m : float
        Line between left and right [m].

    Returns
    -------
    float
        The longer of the `correlation_steps` of the share in the left half and of the mean height.
    """
    left = np.array([(x < split_x_m).mean() for x in frames.x_m])
    height = np.array([z.mean() for z in frames.z_m])
    return max(correlation_steps(left), correlation_steps(height))


# five equal blocks of a window, each left out in turn
Array = NDArray[np.floating]
BLOCKS = 5
LEVEL = 0.95
STUDENT = float(stats.t.ppf((1 + LEVEL) / 2, BLOCKS - 1))
# a shorter window does not tell its own error: its blocks are not independent
FEWEST_CORRELATION_TIMES = 5


def block_edges(n_steps: int) -> NDArray[np.int64]:
    """First step of each of the equal blocks of a window, and its end; (BLOCKS + 1,)."""
    return np.round(np.linspace(0, n_steps, BLOCKS + 1)).astype(np.int64)


def kept_blocks() -> NDArray[np.bool_]:
    """Blocks that are kept while each is left out in turn, (BLOCKS, BLOCKS)."""
    return ~np.eye(BLOCKS, dtype=bool)


def kept_steps(kept: NDArray[np.bool_], n_steps: int) -> NDArray[np.int64]:
    """Weight of each step, 1 in blocks that are kept and 0 in those left out; (n_steps,).

    Parameters
    ----------
    kept : (BLOCKS,) bool array
        Such as a row of `kept_blocks`.
    n_steps : int
        Steps in the window.
    """
    return np.repeat(np.asarray(kept, np.int64), np.diff(block_edges(n_steps)))


def means_left_out(series: NDArray[np.floating]) -> Array:
    """Means over time of a series without each block in turn.

    Parameters
    ----------
    series : (n_steps, ...) array
        Values at each step.

    Returns
    -------
    (BLOCKS, ...) array
    """
    values = np.asarray(series, float)
    weights = np.stack([kept_steps(kept, len(values)) for kept in kept_blocks()])
    return np.tensordot(weights / weights.sum(axis=1, keepdims=True), values, axes=1)


def block_band(
    value: NDArray[np.floating] | float,
    left_out: Array,
    scale: str = "plain",
    correlation_times: float = np.inf,
) -> tuple[Array, Array]:
    """Band that holds the truth with 95 %, from what is estimated without each block of time in turn.

    Parameters
    ----------
    value : (...) array
        Estimate from the whole window: curves, densities, times.
    left_out : (BLOCKS, ...) array
        The same without each block; NaN where there is none.
    scale : {"plain", "positive", "share"}
        The band is symmetric on the number itself, on its logarithm or on its logit, so that it stays
        above 0, or between 0 and 1.
    correlation_times : float
        Correlation times in the window [1]; with fewer than `FEWEST_CORRELATION_TIMES` the window is too
        short to know.

    Returns
    -------
    low, high : (...) array
        NaN where the window is too short, or an estimate is missing.
    """
    value = np.asarray(value, np.float64)
    if correlation_times < FEWEST_CORRELATION_TIMES or len(left_out) != BLOCKS:
        return np.full(value.shape, np.nan), np.full(value.shape, np.nan)
    to, back = _SCALES[scale]
    with np.errstate(all="ignore"):
        low, high = (np.asarray(back(end)) for end in _ends(to(value), to(left_out)))
        # an estimate at the end of its scale, such as the share 1: the band of the number itself, cut there
        edge = ~(np.isfinite(to(value)) & np.isfinite(to(left_out)).all(axis=0)) & np.isfinite(value)
        plain = np.clip(_ends(value, left_out), *_BOUNDS[scale])
    return np.where(edge, plain[0], low), np.where(edge, plain[1], high)


def _ends(value: Array, left_out: Array) -> tuple[Array, Array]:
    spread = left_out - left_out.mean(axis=0)
    half = STUDENT * np.sqrt((BLOCKS - 1) / BLOCKS * (spread**2).sum(axis=0))
    return value - half, value + half


def _same(value: Array) -> Array:
    return np.asarray(value, float)


def _logit(share: Array) -> Array:
    return np.asarray(np.log(share) - np.log1p(-np.asarray(share)))


def _logistic(value: Array) -> Array:
    return np.asarray(1 / (1 + np.exp(-value)))


# kinds of numbers, by how their bands are symmetric, and their bounds
_SCALES: dict[str, tuple[Callable[[Array], Array], Callable[[Array], Array]]] = {
    "plain": (_same, _same),
    "positive": (np.log, np.exp),
    "share": (_logit, _logistic),
}
_BOUNDS = {"plain": (-np.inf, np.inf), "positive": (0, np.inf), "share": (0, 1)}
