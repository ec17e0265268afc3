# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves of particles between cells, counted in one pass over the frames."""

from dataclasses import dataclass
from functools import reduce
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains import hash_counts
from bedchain.errors import DataError
from bedchain.files import read_arrays, write_arrays
from bedchain.trajectory.chunks import chunks
from bedchain.trajectory.frames import whole_steps


@dataclass(frozen=True)
class Counts:
    """Moves counted over some steps; counts of disjoint sets of steps add up (`merge`).

    Parameters
    ----------
    moves : (n_from, n_cells) int64 csr_array
        N_ij summed over the steps: particles in i that are in j one lag later [1].
    shares : (n_from, n_cells) float64 csr_array
        Sum over the steps of N_ij / N_i, on the same entries [1].
    occupied : (n_from,) int64 array
        Steps in which i held a particle [1].
    steps : int
        Steps counted [1].
    lag : int
        Frames in a step [1].
    pairs : (n_from, 2) int64 array or None
        For pair counts: the cell before and the cell now of each row, rising; None for static counts.
    """

    moves: sparse.csr_array
    shares: sparse.csr_array
    occupied: NDArray[np.int64]
    steps: int
    lag: int
    pairs: NDArray[np.int64] | None = None

    @property
    def visits(self) -> NDArray[np.int64]:
        """Particles seen in each cell (or pair) at the start of a step, summed over the steps, (n_from,)."""
        return np.asarray(self.moves.sum(axis=1)).ravel()

    @property
    def n_cells(self) -> int:
        """Number of cells of the grid [1]."""
        return int(self.moves.shape[1])


def count_moves(
    cells: NDArray[np.int32],
    n_cells: int,
    lag: int = 1,
    sliding: bool = True,
    first: int = 0,
    last: int | None = None,
    step_weights: NDArray[np.int64] | None = None,
) -> Counts:
    """Count the moves from cell to cell (Zhuang et al. 2015, Eq. 1: N_ij and N_i).

    Parameters
    ----------
    cells : (n_frames, n_particles) int array
        Cell of each particle; a memory map is read in chunks.
    n_cells : int
        Number of cells of the grid.
    lag : int
        Frames in a step.
    sliding : bool
        Steps start at every frame; False: one step after the other, the lag must divide the window.
    first, last : int
        Steps starting at frames ``first <= t < last`` are counted (default: all there are). Counts of
        ranges that do not overlap add up to those of the whole.
    step_weights : (n_frames - lag,) int array, optional
        How many times the step starting at each frame counts (bootstrap); 1 by default.

    Returns
    -------
    Counts
        With ``moves`` of shape (n_cells, n_cells).

    Raises
    ------
    DataError
        No step fits, a cell number is outside the grid, or the lag does not divide the window.
    """
    starts, weights = step_starts(cells, lag, 1, sliding, first, last, step_weights)
    occupied, table = np.zeros(n_cells, np.int64), hash_counts.empty_table()
    for (before, after), chunk_weights in chunks(cells, n_cells, starts, weights, (0, lag)):
        table = hash_counts.tally_moves(before, after, chunk_weights, occupied, table)
    moves, shares = _csr(*hash_counts.table_entries(table), n_cells, n_cells)
    return Counts(moves, shares, occupied, int(weights.sum()), lag)


def count_pairs(
    cells: NDArray[np.int32],
    n_cells: int,
    lag: int = 1,
    sliding: bool = True,
    first: int = 0,
    last: int | None = None,
    step_weights: NDArray[np.int64] | None = None,
) -> Counts:
    """Count the moves to k of particles now in j that were in i one lag ago (Zhuang et al. 2015, Eq. 2).

    Takes what `count_moves` takes; a step starts at the frame of i, so that ``n_frames - 2 * lag`` steps
    slide over the window.

    Returns
    -------
    Counts
        One row per pair (i, j) that occurs, by rising i, then j; ``pairs`` lists them.

    Raises
    ------
    DataError
        As `count_moves`.
    """
    starts, weights = step_starts(cells, lag, 2, sliding, first, last, step_weights)
    pairs, table = hash_counts.empty_table(np.int64, 1), hash_counts.empty_table()
    occupied = np.zeros(0, np.int64)
    for (before, now, after), chunk_weights in chunks(cells, n_cells, starts, weights, (0, lag, 2 * lag)):
        pairs, occupied, table = hash_counts.tally_pairs(
            before, now, after, chunk_weights, n_cells, pairs, occupied, table
        )
    pair_keys, numbers = hash_counts.table_entries(pairs)
    rank = np.empty(numbers.size, np.int64)
    rank[numbers[:, 0]] = np.arange(numbers.size)
    keys, values = hash_counts.table_entries(table)
    del table
    keys = rank[keys // n_cells] * n_cells + keys % n_cells
    order = np.argsort(keys)
    moves, shares = _csr(keys[order], values[order], pair_keys.size, n_cells)
    listed = np.column_stack(np.divmod(pair_keys, n_cells))
    return Counts(moves, shares, occupied[numbers[:, 0]], int(weights.sum()), lag, listed)


def merge(parts: list[Counts]) -> Counts:
    """Counts of disjoint sets of steps as those of all: exact in the counts, to round-off in the shares.

    Raises
    ------
    DataError
        The parts differ in grid, lag or kind.
    """
    if not parts:
        raise DataError("no counts to merge")
    return reduce(_merge_two, parts)


def write_counts(path: Path | str, counts: Counts) -> None:
    """Write counts, so that jobs can count windows at the same time and another merge them."""
    arrays = {"occupied": counts.occupied, "steps": np.array(counts.steps), "lag": np.array(counts.lag)}
    arrays |= {"moves": counts.moves.data, "shares": counts.shares.data}
    arrays |= {"indices": counts.moves.indices, "indptr": counts.moves.indptr}
    arrays |= {"n_cells": np.array(counts.n_cells)}
    write_arrays(path, arrays if counts.pairs is None else arrays | {"pairs": counts.pairs})


def read_counts(path: Path | str) -> Counts:
    """Counts written by `write_counts`.

    Raises
    ------
    DataError
        The file is missing, cut off, or holds no counts.
    """
    arrays = read_arrays(path)
    try:
        index = (arrays["indices"], arrays["indptr"])
        shape = (arrays["indptr"].size - 1, int(arrays["n_cells"]))
        moves, shares = (
            sparse.csr_array((arrays[name], *index), shape=shape) for name in ("moves", "shares")
        )
        return Counts(
            moves, shares, arrays["occupied"], int(arrays["steps"]), int(arrays["lag"]), arrays.get("pairs")
        )
    except KeyError as error:
        raise DataError(f"{path} holds no counts, {error} is missing: count again") from error


def _merge_two(one: Counts, two: Counts) -> Counts:
    if (one.n_cells, one.lag, one.pairs is None) != (two.n_cells, two.lag, two.pairs is None):
        raise DataError(
            "counts of different grids, lags or kinds do not add up: count again with the same settings"
        )
    if one.pairs is None or two.pairs is None:
        return Counts(
            sparse.csr_array(one.moves + two.moves),
            sparse.csr_array(one.shares + two.shares),
            one.occupied + two.occupied,
            one.steps + two.steps,
            one.lag,
        )
    n_cells = one.n_cells
    keys = [counts.pairs @ np.array([n_cells, 1]) for counts in (one, two) if counts.pairs is not None]
    union = np.union1d(keys[0], keys[1])
    places = [np.searchsorted(union, part) for part in keys]
    parts = list(zip((one, two), places, strict=True))
    moves, shares = (
        sparse.csr_array(sum(_spread(getattr(counts, name), at, union.size) for counts, at in parts))
        for name in ("moves", "shares")
    )
    occupied = np.zeros(union.size, np.int64)
    for counts, at in parts:
        occupied[at] += counts.occupied
    listed = np.column_stack(np.divmod(union, n_cells))
    return Counts(moves, shares, occupied, one.steps + two.steps, one.lag, listed)


def step_starts(
    cells: NDArray[np.int32],
    lag: int,
    moves: int = 1,
    sliding: bool = True,
    first: int = 0,
    last: int | None = None,
    step_weights: NDArray[np.int64] | None = None,
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Starting frames of the steps of so many moves, and how many times each counts; see `count_moves`."""
    if cells.ndim != 2:
        raise DataError(f"cells of shape {cells.shape}, (frames, particles) expected")
    n_starts = len(cells) - moves * lag
    if lag < 1 or n_starts < 1:
        raise DataError(
            f"{len(cells)} frames hold no step of {moves} x {lag} frames: widen the window or cut the lag"
        )
    if not sliding:
        whole_steps(len(cells), lag)
    end = n_starts if last is None else min(last, n_starts)
    starts = np.arange(0, n_starts, 1 if sliding else lag)
    starts = starts[(starts >= first) & (starts < end)]
    if starts.size == 0:
        raise DataError(f"no step starts at frames {first} to {end}: the window is empty")
    if step_weights is None:
        return starts, np.ones(starts.size, np.int64)
    if len(step_weights) < n_starts or min(step_weights) < 0:
        raise DataError(
            f"{len(step_weights)} step weights for {n_starts} steps: one each is needed, none negative"
        )
    weights = np.asarray(step_weights, np.int64)[starts]
    if not weights.any():
        raise DataError("every step weighs nothing: the window is empty")
    return starts, weights


def _csr(
    keys: NDArray[np.int64], values: NDArray[np.float64], n_from: int, n_cells: int
) -> tuple[sparse.csr_array, sparse.csr_array]:
    """Sparse counts and shares from rising keys ``row * n_cells + column``."""
    rows, columns = np.divmod(keys, n_cells)
    indptr = np.zeros(n_from + 1, np.int64)
    np.cumsum(np.bincount(rows, minlength=n_from), out=indptr[1:])
    index = (columns.astype(np.int32), indptr.astype(np.int32))
    shape = (n_from, n_cells)
    moves = sparse.csr_array((values[:, 0].astype(np.int64), *index), shape=shape)
    return moves, sparse.csr_array((values[:, 1].copy(), *index), shape=shape)


def _spread(part: sparse.csr_array, at: NDArray[np.int64], n_rows: int) -> sparse.csr_array:
    """Rows of a matrix moved to other places among more rows."""
    lengths = np.zeros(n_rows + 1, np.int64)
    lengths[at + 1] = np.diff(part.indptr)
    return sparse.csr_array((part.data, part.indices, np.cumsum(lengths)), shape=(n_rows, part.shape[1]))
