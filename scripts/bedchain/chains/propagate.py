# SPDX-License-Identifier: GPL-3.0-or-later
"""Propagation of a chain: exact expectations, and Monte Carlo of every particle."""

from collections.abc import Iterator, Sequence

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy import sparse

from bedchain.errors import DataError

# A row sum is a sum of at most a few hundred shares, each rounded once.
ROW_SUM_TOLERANCE = 1e-12
# Expected values of so many bytes of steps are kept at a time.
BLOCK_BYTES = 32 * 2**20
# Rows of a larger matrix, which no core's cache holds, are read in order, particles by their states: 81 000
# particles in 56 000 states with 456 000 entries then take 6 instead of 13 ms a step.
CACHED_ENTRIES = 200_000


def check_matrix(matrix: sparse.csr_array) -> None:
    """Check that a matrix is row-stochastic.

    Raises
    ------
    DataError
        It is not; the message names the first bad row.
    """
    if matrix.shape[0] != matrix.shape[1]:
        raise DataError(f"a transition matrix of shape {matrix.shape}: it must be square")
    if matrix.nnz and not matrix.data.min() >= 0:
        raise DataError("a transition matrix holds a negative or undefined probability")
    error = np.abs(np.asarray(matrix.sum(axis=1)).ravel() - 1.0)
    if not error.max() <= ROW_SUM_TOLERANCE:
        row = int(np.argmax(~(error <= ROW_SUM_TOLERANCE)))
        raise DataError(
            f"row {row} of the transition matrix is {error[row]:.3g} off a sum of 1: it loses particles"
        )


@njit(cache=True)
def _advance(indptr, indices, data, now, later):  # type: ignore[no-untyped-def]
    """One step of all groups, ``later = now @ P``; now and later are (n_states, n_groups)."""
    n_groups = now.shape[1]
    later[:] = 0.0
    for i in range(now.shape[0]):
        occupied = False
        for g in range(n_groups):
            occupied |= now[i, g] != 0.0
        if not occupied:
            continue
        for entry in range(np.uint64(indptr[i]), np.uint64(indptr[i + 1])):
            j = np.uint32(indices[entry])
            for g in range(n_groups):
                later[j, g] += data[entry] * now[i, g]


@njit(cache=True)
def _advance_many(indptr, indices, data, now, later, totals, steps):  # type: ignore[no-untyped-def]
    for _ in range(steps):
        _advance(indptr, indices, data, now, later)
        # Row sums are 1 to round-off only: without correction the error grows with the number of steps.
        for g in range(now.shape[1]):
            total = 0.0
            for i in range(now.shape[0]):
                total += later[i, g]
            if total > 0.0:
                for i in range(now.shape[0]):
                    later[i, g] *= totals[g] / total
        now, later = later, now
    return now, later


def propagate(
    matrix: sparse.csr_array, start: NDArray[np.float64], steps: Sequence[int] | int
) -> NDArray[np.float64]:
    """Expected distributions of marked groups, exactly: ``p_next = p @ P``.

    Parameters
    ----------
    matrix : (n_states, n_states) csr_array
        Row-stochastic.
    start : (n_groups, n_states) array
        Particles (or probability) of each group in each state at step 0.
    steps : int or rising sequence of int
        Steps of the result; an int stands for all from 0 to it.

    Returns
    -------
    (n_steps, n_groups, n_states) array
        The groups' totals stay those of the start: each step is scaled to remove its round-off.

    Raises
    ------
    DataError
        The matrix is not row-stochastic, or the steps do not rise.
    """
    check_matrix(matrix)
    step_numbers = np.arange(steps + 1) if isinstance(steps, int) else np.asarray(steps, dtype=np.int64)
    if step_numbers.size and (step_numbers[0] < 0 or (np.diff(step_numbers) < 0).any()):
        raise DataError(f"steps {list(step_numbers)} must rise from 0 or more")
    now = np.array(np.atleast_2d(start).T, dtype=np.float64, order="C")
    later = np.empty_like(now)
    totals = now.sum(axis=0)
    distributions = np.empty((step_numbers.size, now.shape[1], now.shape[0]))
    done = 0
    for place, step in enumerate(step_numbers):
        now, later = _advance_many(
            matrix.indptr, matrix.indices, matrix.data, now, later, totals, int(step) - done
        )
        done = int(step)
        distributions[place] = now.T
    return distributions


@njit(cache=True)
def _look_back(indptr, indices, data, out):  # type: ignore[no-untyped-def]
    """Expected values of two observables by state after 1, 2, ... steps, (n_steps + 1, n_states, 2)."""
    for step in range(out.shape[0] - 1):
        # Two views and unsigned indices: three times as fast as out[step, j, 0] with signed indices.
        now, back = out[step], out[step + 1]
        for i in range(now.shape[0]):
            first, second = 0.0, 0.0
            for entry in range(np.uint64(indptr[i]), np.uint64(indptr[i + 1])):
                j = np.uint32(indices[entry])
                first += data[entry] * now[j, 0]
                second += data[entry] * now[j, 1]
            back[i, 0] = first
            back[i, 1] = second


def expected_values(
    matrix: sparse.csr_array, start: NDArray[np.float64], values: NDArray[np.float64], steps: int
) -> NDArray[np.float64]:
    """Expected mean of observables over marked groups at steps 0 to ``steps``, exactly.

    The observables are propagated backwards, ``f_t = P f_(t-1)``, once for all groups.

    Parameters
    ----------
    matrix : (n_states, n_states) csr_array
        Row-stochastic.
    start : (n_groups, n_states) array
        Particles of each group in each state at step 0.
    values : (n_obs, n_states) array
        Value of each observable in each state.
    steps : int
        Number of steps.

    Returns
    -------
    (steps + 1, n_groups, n_obs) array
        Means over the particles of the group; NaN for a group without particles.
    """
    check_matrix(matrix)
    totals = start.sum(axis=1)
    weights = np.divide(start, totals[:, None], out=np.full(start.shape, np.nan), where=totals[:, None] > 0)
    n_obs = values.shape[0]
    means = np.empty((steps + 1, start.shape[0], n_obs))
    block = int(max(1, min(steps + 1, BLOCK_BYTES // (16 * matrix.shape[0]))))
    for o in range(0, n_obs, 2):
        out = np.empty((block + 1, matrix.shape[0], 2))
        out[0] = values[[o, min(o + 1, n_obs - 1)]].T
        for done in range(0, steps + 1, block):
            part = out[: min(block, steps + 1 - done) + 1]
            _look_back(matrix.indptr, matrix.indices, matrix.data, part)
            means[done : done + block, :, o : o + 2] = (weights @ part[:-1])[:, :, : n_obs - o]
            out[0] = part[-1]
    return means


def cumulative_rows(matrix: sparse.csr_array) -> NDArray[np.float64]:
    """Cumulative probabilities along each row, on the entries of the matrix; each row's last is exactly 1."""
    running = np.cumsum(matrix.data)
    lengths = np.diff(matrix.indptr)
    before = np.where(matrix.indptr[:-1] > 0, running[matrix.indptr[:-1] - 1], 0.0)
    cdf = running - np.repeat(before, lengths)
    np.clip(cdf, 0.0, 1.0, out=cdf)
    cdf[matrix.indptr[1:][lengths > 0] - 1] = 1.0
    return np.asarray(cdf)


@njit(cache=True)
def _move(indptr, indices, cdf, guide, states, draws, order):  # type: ignore[no-untyped-def]
    """Move every particle to the first entry of its row whose cumulative probability exceeds its draw."""
    for particle in order:
        first = np.uint64(indptr[states[particle]])
        length = np.uint64(indptr[states[particle] + 1]) - first
        draw = draws[particle]
        entry = first + np.uint64(guide[first + np.uint64(draw * length)])
        while cdf[entry] <= draw:
            entry += np.uint64(1)
        states[particle] = indices[entry]


@njit(cache=True)
def _sort_by_state(states, order, ends):  # type: ignore[no-untyped-def]
    """Set ``order`` to the particles by rising state; ``ends`` (n_states + 1,) is for work."""
    ends[:] = 0
    for state in states:
        ends[state + 1] += 1
    for state in range(ends.size - 1):
        ends[state + 1] += ends[state]
    for particle in range(states.size):
        order[ends[states[particle]]] = particle
        ends[states[particle]] += 1


@njit(cache=True)
def _guide(indptr, cdf):  # type: ignore[no-untyped-def]
    """First entry to search in a row, for draws in each of as many equal parts as the row has entries."""
    guide = np.zeros(cdf.size, np.int32)
    for i in range(indptr.size - 1):
        first, length = indptr[i], indptr[i + 1] - indptr[i]
        entry = 0
        for part in range(length):
            # Slightly early, so that rounding of draw * length cannot skip an entry.
            while entry < length - 1 and cdf[first + entry] <= (part - 1e-9) / length:
                entry += 1
            guide[first + part] = entry
    return guide


def walk(
    matrix: sparse.csr_array, start: NDArray[np.integer], steps: int, rng: np.random.Generator
) -> Iterator[NDArray[np.int32]]:
    """States of every particle at steps 0 to ``steps``, drawn at random (Monte Carlo).

    Parameters
    ----------
    matrix : (n_states, n_states) csr_array
        Row-stochastic.
    start : (n_particles,) int array
        State of each particle at step 0.
    steps : int
        Number of steps.
    rng : numpy Generator
        A draw per particle and step, in the order of the particles: the same seed gives the same paths.

    Yields
    ------
    (n_particles,) int32 array
        The same array each time: copy it to keep it.
    """
    check_matrix(matrix)
    cdf = cumulative_rows(matrix)
    guide = _guide(matrix.indptr, cdf)
    states = np.array(start, dtype=np.int32)
    order, ends = np.arange(states.size, dtype=np.int32), np.empty(matrix.shape[0] + 1, np.int32)
    yield states
    for _ in range(steps):
        if matrix.nnz > CACHED_ENTRIES:
            _sort_by_state(states, order, ends)
        _move(matrix.indptr, matrix.indices, cdf, guide, states, rng.random(states.size), order)
        yield states


def simulate(
    matrix: sparse.csr_array, start: NDArray[np.integer], steps: int, rng: np.random.Generator
) -> NDArray[np.int32]:
    """States of `walk` as an array, (steps + 1, n_particles) int32."""
    paths = np.empty((steps + 1, len(start)), np.int32)
    for step, states in enumerate(walk(matrix, start, steps, rng)):
        paths[step] = states
    return paths
