# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain of any model carried on from all frames of a window, against what the frames themselves show.

The Chapman-Kolmogorov test for whatever is Markov on some set of states: a chain learned at a lag and run k
steps must give what is counted k lags apart. For the static chain `consistency.chapman_kolmogorov` is the
same from counts alone; here particles start in the states of their model, and every time has its value.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains import propagate
from bedchain.chains.markov_chain import MarkovChain
from bedchain.errors import DataError
from bedchain.measures import mixing
from bedchain.trajectory.frames import Frames

# up to so many keys a list of all that there might be is faster than sorting those that there are
LISTED_KEYS = 50_000_000


@dataclass(frozen=True)
class Sides:
    """Who is on which side in each frame, and is so again some frames later.

    Parameters
    ----------
    split_x_m, split_z_m : float
        Lines between left and right, and between low and up [m].
    marked : (n_frames, 4, n_particles) bool array
        Groups of `mixing.GROUPS`.
    gaps : (n_gaps,) int array
        Rising numbers of frames between two looks.
    still : (n_gaps, n_frames, 4) int64 array
        Particles of each group of a frame that are on its side that many frames later [1]; 0 where the
        window ends before.
    """

    split_x_m: float
    split_z_m: float
    marked: NDArray[np.bool_]
    gaps: NDArray[np.int64]
    still: NDArray[np.int64]


def count_sides(frames: Frames, split_x_m: float, split_z_m: float, gaps: Sequence[int]) -> Sides:
    """Look at the particles of every frame again some frames later.

    Parameters
    ----------
    frames : Frames
        The window.
    split_x_m, split_z_m : float
        Lines between left and right, and between low and up [m].
    gaps : sequence of int
        Rising numbers of frames between two looks.

    Returns
    -------
    Sides

    Raises
    ------
    DataError
        A gap is as long as the window.
    """
    n_frames = len(frames.times_s)
    if max(gaps) >= n_frames:
        raise DataError(f"{n_frames} frames hold no two that are {max(gaps)} apart: widen the window")
    places = zip(frames.x_m, frames.z_m, strict=True)
    marked = np.array([mixing.sides(np.asarray(x), np.asarray(z), split_x_m, split_z_m) for x, z in places])
    still, bits = np.zeros((len(gaps), n_frames, 4), np.int64), np.packbits(marked, axis=2)
    for row, gap in enumerate(gaps):
        both = bits[: n_frames - gap] & bits[gap:]
        still[row, : n_frames - gap] = np.bitwise_count(both).sum(axis=2, dtype=np.int64)
    return Sides(split_x_m, split_z_m, marked, np.asarray(gaps, np.int64), still)


def counted(sides: Sides, weights: NDArray[np.int64] | None = None) -> NDArray[np.float64]:
    """Share of each group that is on its side each gap later, as the frames show it.

    Parameters
    ----------
    sides : Sides
    weights : (n_starts,) int array, optional
        How many times each of the first frames counts as a start (bootstrap); the others count 0.

    Returns
    -------
    (n_gaps, 4) array
        Over all starts that the window allows [1].
    """
    n_frames = len(sides.marked)
    times = np.ones(n_frames, np.int64)
    if weights is not None:
        times = np.concatenate((weights, np.zeros(n_frames - len(weights), np.int64)))
    size = sides.marked.sum(axis=2)
    began = np.array([times[: n_frames - gap] @ size[: n_frames - gap] for gap in sides.gaps])
    stayed = np.einsum("f,gfs->gs", times, sides.still)
    return np.divide(stayed, began, out=np.full(stayed.shape, np.nan), where=began > 0)


@dataclass(frozen=True)
class Starts:
    """The pasts that particles have in the frames of a window, each once, and how many have it.

    Parameters
    ----------
    symbols : (history, n_pasts) int32 array
        What particles of each past show in the frames, one lag apart, that make it, oldest first.
    number : tuple of 4 (n_starts, n_pasts) csr_array
        Particles of each group with each past in each frame that a step follows [1].
    """

    symbols: NDArray[np.int32]
    number: tuple[sparse.csr_array, ...]


def count_starts(frames: Frames, chain: MarkovChain, sides: Sides) -> Starts:
    """Find the pasts in a window, as a chain sees them.

    Parameters
    ----------
    frames : Frames
        The window of ``sides``.
    chain : MarkovChain
        Its lag, history and symbols count, not its probabilities.
    sides : Sides

    Returns
    -------
    Starts
        Frames that too few others lead up to hold no particles.
    """
    lag, history, base = chain.lag, chain.history, chain.n_symbols
    n_starts, span = len(frames.times_s) - lag, (history - 1) * lag
    before, shown = span + chain.back, chain.symbols(frames)
    keys = np.zeros((n_starts - before, shown.shape[1]), np.int64)
    for ago in range(span, -1, -lag):
        keys = keys * base + shown[span - ago : n_starts - chain.back - ago]
    pasts, which = ranked(keys, base**history)
    groups = np.moveaxis(sides.marked[before:n_starts], 1, 0)
    number = tuple(_by_frame(which, group, before, pasts.size) for group in groups)
    symbols = np.array([pasts // base**ago % base for ago in range(history)][::-1], np.int32)
    return Starts(symbols, number)


def ranked(keys: NDArray[np.int64], n_keys: int) -> tuple[NDArray[np.int64], NDArray[np.integer]]:
    """Different keys, rising, and the place of each of the given ones among them.

    Parameters
    ----------
    keys : (...) int64 array
        From 0 to ``n_keys - 1``.
    n_keys : int
        Up to `LISTED_KEYS` they are looked up in a list of all that there might be, above that sorted.

    Returns
    -------
    found : (n_found,) int64 array
    which : (...) int array
    """
    if n_keys > LISTED_KEYS:
        found, which = np.unique(keys, return_inverse=True)
        return found, which.reshape(keys.shape)
    seen = np.zeros(n_keys, bool)
    seen[keys] = True
    place = np.cumsum(seen, dtype=np.int32) - 1
    return np.flatnonzero(seen), place[keys]


def _by_frame(
    which: NDArray[np.integer], group: NDArray[np.bool_], before: int, n_pasts: int
) -> sparse.csr_array:
    """Particles of a group with each past in each frame, after as many empty frames as come before."""
    places, numbers = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    for now, marked in zip(which, group, strict=True):
        held = np.bincount(now[marked], minlength=n_pasts)
        places.append(np.flatnonzero(held))
        numbers.append(held[places[-1]])
    ends = np.cumsum([0] * before + [place.size for place in places])
    return sparse.csr_array(
        (np.concatenate(numbers), np.concatenate(places), ends), shape=(before + len(which), n_pasts)
    )


def propagated(
    chain: MarkovChain, starts: Starts, sides: Sides, weights: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Share of each group that is on its side after steps of a chain, expected from all starts.

    Parameters
    ----------
    chain : MarkovChain
        Of any lag.
    starts : Starts
        Of a chain of the same lag, history and symbols.
    sides : Sides
    weights : (n_starts,) int array
        How many times each frame counts as a start (bootstrap).

    Returns
    -------
    rows : (n,) int64 array
        Which of ``sides.gaps`` are whole steps of the chain.
    remaining : (n, 4) array
        After these gaps [1].
    """
    rows = np.flatnonzero(sides.gaps % chain.lag == 0)
    steps = sides.gaps[rows] // chain.lag
    shares = mixing.side_shares(chain.grid, sides.split_x_m, sides.split_z_m)[:, chain.cell_of_state]
    states = chain.states_of(starts.symbols)
    begin = np.array(
        [np.bincount(states, weights @ number, chain.matrix.shape[0]) for number in starts.number]
    )
    found = propagate.expected_values(chain.matrix, begin, shares, int(steps.max(initial=0)))
    return rows, found[steps][:, np.arange(4), np.arange(4)]
