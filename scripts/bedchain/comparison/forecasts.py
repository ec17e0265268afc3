# SPDX-License-Identifier: GPL-3.0-or-later
"""Mixing of a chain started in all frames of a window, and mixing counted in the frames.

For the Chapman-Kolmogorov test of a model that is Markov on a set of states: k steps of a chain learned at a
lag must give the mixing that is counted k lags apart. Particles start in the states of the model.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bedchain.chains import propagate
from bedchain.chains.markov_chain import MarkovChain
from bedchain.errors import DataError
from bedchain.measures import mixing
from bedchain.trajectory.frames import Frames

# up to this number of possible keys a list of all of them is faster than sorting the keys that occur
LISTED_KEYS = 50_000_000


@dataclass(frozen=True)
class Sides:
    """Sides of all particles in each frame, and numbers of those that are on the same side some frames later.

    Parameters
    ----------
    split_x_m, split_z_m : float
        Lines between left and right, and between low and up [m].
    marked : (n_frames, 4, n_particles) bool array
        Groups of `mixing.GROUPS`.
    gaps : (n_gaps,) int array
        Rising numbers of frames between two counts [1].
    still : (n_gaps, n_frames, 4) int64 array
        Particles of each group of a frame that are on its side so many frames later [1]; 0 beyond the end
        of the window.
    seen : (n_gaps, n_frames, 4) int64 array, optional
        Particles of each group of a frame that are anywhere so many frames later [1]; without it all are.
    """

    split_x_m: float
    split_z_m: float
    marked: NDArray[np.bool_]
    gaps: NDArray[np.int64]
    still: NDArray[np.int64]
    seen: NDArray[np.int64] | None = None


def count_sides(frames: Frames, split_x_m: float, split_z_m: float, gaps: Sequence[int]) -> Sides:
    """Sides of the particles in every frame and some frames later.

    Parameters
    ----------
    frames : Frames
        The window.
    split_x_m, split_z_m : float
        Lines between left and right, and between low and up [m].
    gaps : sequence of int
        Rising numbers of frames between two counts [1].

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
    gaps_array = np.asarray(gaps, np.int64)
    there = marked[:, :1] | marked[:, 1:2]
    if there.all():
        return Sides(split_x_m, split_z_m, marked, gaps_array, still)
    seen = np.zeros_like(still)
    for row, gap in enumerate(gaps):
        seen[row, : n_frames - gap] = (marked[: n_frames - gap] & there[gap:]).sum(axis=2)
    return Sides(split_x_m, split_z_m, marked, gaps_array, still, seen)


def counted(sides: Sides, weights: NDArray[np.int64] | None = None) -> NDArray[np.float64]:
    """Share of each group that is on its side after each gap, counted in the frames.

    Parameters
    ----------
    sides : Sides
    weights : (n_starts,) int array, optional
        How many times each of the first frames counts as a start; later frames count 0 times.

    Returns
    -------
    (n_gaps, 4) array
        Over all starts in the window whose particle is seen at both ends [1].
    """
    n_frames = len(sides.marked)
    times = np.ones(n_frames, np.int64)
    if weights is not None:
        times = np.concatenate((weights, np.zeros(n_frames - len(weights), np.int64)))
    if sides.seen is not None:
        began = np.einsum("f,gfs->gs", times, sides.seen)
    else:
        size = sides.marked.sum(axis=2)
        began = np.array([times[: n_frames - gap] @ size[: n_frames - gap] for gap in sides.gaps])
    stayed = np.einsum("f,gfs->gs", times, sides.still)
    return np.divide(stayed, began, out=np.full(stayed.shape, np.nan), where=began > 0)


@dataclass(frozen=True)
class Starts:
    """Distinct pasts of the particles in the frames of a window, and the number of particles with each.

    Parameters
    ----------
    symbols : (history, n_pasts) int32 array
        Symbols (`MarkovChain.symbols`) of each past, one lag apart, oldest first.
    number : (4, n_blocks, n_pasts) int64 array
        Particles of each group with each past at the starts of the steps, summed over each block of time [1].
    """

    symbols: NDArray[np.int32]
    number: NDArray[np.int64]


def count_starts(frames: Frames, chain: MarkovChain, sides: Sides, edges: NDArray[np.integer]) -> Starts:
    """Distinct pasts of the particles of a window, in the symbols of a chain.

    Parameters
    ----------
    frames : Frames
        The window of ``sides``.
    chain : MarkovChain
        Its lag, history and symbols are used, not its probabilities.
    sides : Sides
    edges : (n_blocks + 1,) int array
        First frame of each block of starts, and the end.

    Returns
    -------
    Starts
        Without particles in frames that have too few frames before them.
    """
    lag, history, base = chain.lag, chain.history, chain.n_symbols
    n_starts, span = len(frames.times_s) - lag, (history - 1) * lag
    before, frame_symbols = span + chain.back, chain.symbols(frames)
    whole = np.int32 if base**history <= np.iinfo(np.int32).max else np.int64
    keys = np.zeros((n_starts - before, frame_symbols.shape[1]), whole)
    for row, now in enumerate(keys):  # frame by frame, which a core's cache holds
        for ago in range(span, -1, -lag):
            now *= base
            now += frame_symbols[span - ago + row]
    pasts, ranks = ranked(keys, base**history)
    marked, held = sides.marked[before:n_starts], np.empty((4, len(edges) - 1, pasts.size), np.int64)
    ends = np.maximum(np.asarray(edges) - before, 0)
    for block, (first, last) in enumerate(zip(ends[:-1], ends[1:], strict=True)):
        # left or right, and low or up: four quarters, of which each group has two
        place = 4 * ranks[first:last].astype(np.int64)
        place += 2 * marked[first:last, 0].astype(np.int8) + marked[first:last, 2]
        held[:, block] = np.bincount(place.ravel(), minlength=4 * pasts.size).reshape(-1, 4).T
    number = np.stack([held[2] + held[3], held[0] + held[1], held[1] + held[3], held[0] + held[2]])
    symbols = np.array([pasts // base**ago % base for ago in range(history)][::-1], np.int32)
    return Starts(symbols, number)


def ranked(keys: NDArray[np.integer], n_keys: int) -> tuple[NDArray[np.int64], NDArray[np.integer]]:
    """Distinct keys, rising, and the rank of each key among them.

    Parameters
    ----------
    keys : (...) int array
        From 0 to ``n_keys - 1``.
    n_keys : int
        Possible keys; up to `LISTED_KEYS` ranks come from a list of all of them, above from sorting.

    Returns
    -------
    distinct : (n_distinct,) int64 array
    ranks : (...) int array
    """
    if n_keys > LISTED_KEYS:
        distinct, ranks = np.unique(keys, return_inverse=True)
        return distinct, ranks.reshape(keys.shape)
    occurs = np.zeros(n_keys, bool)
    occurs[keys] = True
    rank = np.cumsum(occurs, dtype=np.int32) - 1
    return np.flatnonzero(occurs), rank[keys]


def propagated(
    chain: MarkovChain, starts: Starts, sides: Sides, kept: NDArray[np.integer] | NDArray[np.bool_]
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Expected share of each group that is on its side after steps of a chain from all starts.

    Parameters
    ----------
    chain : MarkovChain
        Of any lag.
    starts : Starts
        Of a chain of the same lag, history and symbols.
    sides : Sides
    kept : (n_blocks,) array
        Blocks of starts that count: 1 or 0, or how many times.

    Returns
    -------
    rows : (n,) int64 array
        Numbers of the ``sides.gaps`` that are whole steps of the chain.
    remaining : (n, 4) array
        [1].
    """
    rows = np.flatnonzero(sides.gaps % chain.lag == 0)
    steps = sides.gaps[rows] // chain.lag
    shares = mixing.side_shares(chain.grid, sides.split_x_m, sides.split_z_m)[:, chain.cell_of_state]
    states = chain.states_of(starts.symbols)
    held = np.tensordot(np.asarray(kept, float), starts.number, axes=(0, 1))
    begin = np.array([np.bincount(states, of_group, chain.matrix.shape[0]) for of_group in held])
    # left and right are complements, as are low and up
    means = propagate.expected_values(chain.matrix, begin, shares[[0, 2]], int(steps.max(initial=0)))[steps]
    return rows, np.stack((means[:, 0, 0], 1 - means[:, 1, 0], means[:, 2, 1], 1 - means[:, 3, 1]), axis=1)
