# SPDX-License-Identifier: GPL-3.0-or-later
"""Error bars by leaving out blocks of time in turn.

Particles of a bubble move together, and successive frames are similar: the binomial error of as many
independent particles is far too small. A window is cut into five equal blocks, and what is estimated is
estimated again without each of them (grouped jackknife; Quenouille 1956, Tukey 1958; Miller, Biometrika 61
(1974) 1). The five results theta_i have ``se^2 = (4 / 5) sum (theta_i - mean)^2``, and the band is the
estimate -+ 2.776 se, Student's t of four degrees of freedom. `study_bands.py` measures how often it holds the
truth.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy import special

from bedchain.trajectory.frames import Frames

Array = NDArray[np.float64]

BLOCKS = 5
LEVEL = 0.95
STUDENT = float(special.stdtrit(BLOCKS - 1, (1 + LEVEL) / 2))
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


def block_error(left_out: NDArray[np.floating]) -> Array:
    """Standard error of what is estimated without each block in turn: ``se`` of this module.

    Parameters
    ----------
    left_out : (BLOCKS, ...) array

    Returns
    -------
    (...) array
    """
    spread = np.asarray(left_out, float) - np.mean(left_out, axis=0)
    return np.asarray(np.sqrt((BLOCKS - 1) / BLOCKS * (spread**2).sum(axis=0)))


def mean_error(series: NDArray[np.floating]) -> Array:
    """Standard error of a mean over time, particles or places, from blocks of neighbours.

    Parameters
    ----------
    series : (n, ...) array
        Neighbours in time or space beside each other, at least `BLOCKS`.

    Returns
    -------
    (...) array
    """
    return block_error(means_left_out(series))


def block_band(
    value: NDArray[np.floating] | float,
    left_out: NDArray[np.floating],
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
    number: Array = np.asarray(value, np.float64)
    without: Array = np.asarray(left_out, np.float64)
    if correlation_times < FEWEST_CORRELATION_TIMES or len(without) != BLOCKS:
        return np.full(number.shape, np.nan), np.full(number.shape, np.nan)
    to, back = _SCALES[scale]
    with np.errstate(all="ignore"):
        low, high = (back(end) for end in _ends(to(number), to(without)))
        # an estimate at the end of its scale, such as the share 1: the band of the number itself, cut there
        edge = ~(np.isfinite(to(number)) & np.isfinite(to(without)).all(axis=0)) & np.isfinite(number)
        plain = np.clip(_ends(number, without), *_BOUNDS[scale])
    return np.where(edge, plain[0], low), np.where(edge, plain[1], high)


def _ends(value: Array, left_out: Array) -> tuple[Array, Array]:
    half = STUDENT * block_error(left_out)
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


def correlation_steps(series: NDArray[np.floating]) -> float:
    """Integrated autocorrelation time of a series, ``1 + 2 sum(rho)`` up to the first rho below 0 [steps].

    Parameters
    ----------
    series : (n_steps,) array
        Such as the share of the particles in the left half, or the height of their centre of mass.

    Returns
    -------
    float
        At least 1; a window of n steps knows a mean as well as n / so many independent values.
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


def correlation_times(frames: Frames, split_x_m: float, lag: int = 1) -> float:
    """Correlation times in a window, of the longer of `memory` and a lag [1]; arguments as `memory`."""
    return (len(frames.times_s) - lag) / max(memory(frames, split_x_m), lag)


def shortness(times: float) -> str:
    """Words on a window of so many correlation times: empty where it is long enough for a band."""
    if times >= FEWEST_CORRELATION_TIMES:
        return ""
    return f"{times:.1f} correlation times are too short to know the error: no bands"
