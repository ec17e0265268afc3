# SPDX-License-Identifier: GPL-3.0-or-later
"""Slowest processes of a chain: eigenvalues with both eigenvectors, timescales, periods, and mixing time.

The chain need not be reversible: particles circulate, and a complex pair of eigenvalues is a process that
goes round while it decays.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import linalg as dense
from scipy import sparse
from scipy.sparse import linalg

from bedchain.chains.classes import classes_of

Complex = NDArray[np.complex128]

# Up to this many states a dense eigenvalue solver is faster, and certain to find all eigenvalues.
DENSE_STATES = 400
# ARPACK works on a power of the matrix, a prime, in a basis of so many times the vectors asked for, and some
# more. On the paper's chains the 5th in 40 vectors takes as long as the 23rd in 27 at 0.025 s (0.6 s for
# 54 000 states), and a fifth of it at 0.8 s, where the 23rd leaves nothing of the processes wanted. After a
# power that leaves too little of them comes a lower one.
POWERS = (5, 1)
BASIS_TIMES, BASIS_MORE = 4, 4
# Relative error of eigenvalues by iteration; residual of an eigenvector beyond which a lower power is taken
EIGENVALUE_ERROR, RESIDUAL = 1e-10, 1e-6
# Processes that less of the long-run mass takes part in are dropped, as those of a few cells of the freeboard
LEAST_HELD = 0.01
# Eigenvalues asked for beyond those wanted, since some are dropped; at most so many times as many
EXTRA, MOST = 3, 4
# A chain learned without a block smooths the modes of the whole one until this share of the fastest is left,
# in so many steps at most: in more, processes of a few cells grow, and at long lags only round-off stays
LEFT_OF_FASTEST, MOST_SMOOTHING = 0.18, 48
# Shares of the mass below this are round-off of the solver [1]
ROUND_OFF = 1e-12


@dataclass(frozen=True)
class Modes:
    """Slowest processes, slowest first, without the stationary one.

    Parameters
    ----------
    eigenvalues : (n,) complex array
    left : (n_states, n) complex array
        Left eigenvectors: excess of particles in each state while the process decays, sum of sizes 1.
    right : (n_states, n) complex array
        Right eigenvectors: how much particles that start in each state take part, largest size 1.
    held : (n,) array
        Share of the long-run mass that takes part [1], see `held_share`.
    density : (n_states,) array
        Long-run distribution of the largest class, if no particle can leave it; else what it tends to while
        particles leave it, and where they end, in equal parts [1].
    dropped : (n_dropped,) complex array
        Eigenvalues of the processes with less than `LEAST_HELD`.
    """

    eigenvalues: Complex
    left: Complex
    right: Complex
    held: NDArray[np.float64]
    density: NDArray[np.float64]
    dropped: Complex

    def timescales_s(self, lag_s: float) -> NDArray[np.float64]:
        """Relaxation times ``-lag / ln |lambda|``, slowest first, (n,) [s]."""
        return timescales_s(self.eigenvalues, lag_s)

    def periods_s(self, lag_s: float) -> NDArray[np.float64]:
        """Time in which each process goes round, ``2 pi lag / |arg lambda|``, (n,) [s]; infinite if real."""
        angle = np.abs(np.angle(self.eigenvalues))
        round_trip = (angle > ROUND_OFF) & (self.eigenvalues.imag != 0)
        return np.where(round_trip, 2 * np.pi * lag_s / np.where(round_trip, angle, 1), np.inf)

    def again(self, matrix: sparse.csr_array, place: NDArray[np.integer]) -> Complex:
        """The same processes in a chain learned without a block of time: their eigenvalues, (n,).

        The modes of the whole chain are smoothed by some steps of the other one and projected on those of
        the whole chain (Rayleigh-Ritz): an error of second order in the change, at a tenth of the cost of
        new eigenvectors, and no process of a few cells gets among them.

        Parameters
        ----------
        matrix : (n, n) csr_array
            Of the other chain.
        place : (n,) int array
            State of this chain for each state of the other.
        """
        left = _real_basis(self.density, self.left, self.eigenvalues)[place]
        now = _real_basis(np.ones(len(self.density)), self.right, self.eigenvalues)[place]
        for _ in range(_smoothing_steps(self.eigenvalues)):
            now = matrix @ now
        values = dense.eigvals(left.T @ (matrix @ now), left.T @ now)
        values = np.delete(values, np.argmin(np.abs(values - 1)))
        return np.asarray(values[_order(values)][: self.eigenvalues.size], np.complex128)


def slowest_modes(matrix: sparse.csr_array, n: int = 5) -> Modes:
    """The slowest processes that at least `LEAST_HELD` of the long-run mass takes part in.

    Parameters
    ----------
    matrix : (n_states, n_states) csr_array
        Row-stochastic. Processes are those of the largest communicating class and, if particles can leave it,
        of the largest closed class with the leak into it; states apart do not count.
    n : int
        Processes wanted.

    Returns
    -------
    Modes
        At most n.
    """
    states, left_for_good = _mixing_states(matrix)
    part = sparse.csr_array(matrix[states][:, states])
    asked = n + 1 + EXTRA
    while True:
        values, left, right = _eigenvectors(part, asked)
        density = _mass(values, left, left_for_good)
        first = int(np.argmin(np.abs(values - 1)))
        values, left, right = (np.delete(array, first, axis=-1) for array in (values, left, right))
        held = held_share(left, density)
        kept = held >= LEAST_HELD
        if kept.sum() >= n or asked >= min(states.size, MOST * (n + 1)):
            break
        asked *= 2
    which, size = np.flatnonzero(kept)[:n], matrix.shape[0]
    dropped = values[~kept][np.abs(values[~kept]) >= np.abs(values[which]).min(initial=1.0)]
    whole_left, whole_right = np.zeros((2, size, which.size), np.complex128)
    whole_left[states], whole_right[states] = left[:, which], right[:, which]
    whole_density = np.zeros(size)
    whole_density[states] = density
    return Modes(values[which], whole_left, whole_right, held[which], whole_density, dropped)


def held_share(left: Complex, density: NDArray[np.float64]) -> NDArray[np.float64]:
    """Share of the long-run mass that takes part in processes, ``(sum |l|)^2 / sum(l^2 / density)``.

    Parameters
    ----------
    left : (n_states, n) complex array
        Left eigenvectors.
    density : (n_states,) array
        [1].

    Returns
    -------
    (n,) array
        1 for an exchange between two halves, 4 p (1 - p) between a share p and the others [1].
    """
    size = np.abs(left)
    spread = (size**2 / np.maximum(density, ROUND_OFF)[:, None]).sum(axis=0)
    return np.asarray(size.sum(axis=0) ** 2 / np.where(spread > 0, spread, 1))


def timescales_s(eigenvalues: Complex, lag_s: float) -> NDArray[np.float64]:
    """Relaxation times ``-lag / ln |lambda|`` [s]; infinite for a size of 1."""
    inner = np.clip(np.abs(eigenvalues), np.finfo(float).tiny, 1.0)
    with np.errstate(divide="ignore"):
        return np.asarray(lag_s / np.abs(np.log(inner)))


def mixing_time(slowest_s: float, lag_s: float) -> float:
    """Mixing time by the spectral gap, ``lag / (1 - |lambda|)``, from the slowest timescale [s]."""
    if not slowest_s > 0:
        return lag_s if slowest_s == 0 else float("nan")
    gap = -np.expm1(-lag_s / slowest_s)
    return float(lag_s / gap) if gap > np.finfo(float).eps else float("inf")


def _mixing_states(matrix: sparse.csr_array) -> tuple[NDArray[np.int64], bool]:
    """States of the largest class and the largest closed one, and if particles leave the former for good."""
    label, closed = classes_of(matrix)
    size = np.bincount(label)
    largest, last = int(np.argmax(size)), int(np.argmax(np.where(closed, size, 0)))
    if size[last] == size[largest]:
        largest = last
    return np.flatnonzero((label == largest) | (label == last)), largest != last


def _mass(values: Complex, left: Complex, left_for_good: bool) -> NDArray[np.float64]:
    """See `Modes.density`."""
    stationary = np.abs(left[:, np.argmin(np.abs(values - 1))])
    if not left_for_good:
        return np.asarray(stationary / stationary.sum())
    # the slowest process is the leak: its excess, but for where the particles end
    leak = np.abs(left[:, np.argsort(np.abs(values - 1))[1]])
    return np.asarray(stationary / stationary.sum() + leak / leak.sum()) / 2


def _eigenvectors(part: sparse.csr_array, n: int) -> tuple[Complex, Complex, Complex]:
    """The n largest eigenvalues, by falling size, and their left and right eigenvectors."""
    if part.shape[0] <= max(DENSE_STATES, n + 2):
        values, left, right = dense.eig(part.toarray(), left=True, right=True)
        order = _order(values)[:n]
        values, left, right = values[order], left[:, order].conj(), right[:, order]
    else:
        values, right = _by_iteration(part, n)
        left = _by_iteration(sparse.csr_array(part.T), n)[1]
    left = left / np.abs(left).sum(axis=0)
    return values, left, right / np.abs(right).max(axis=0)


def _by_iteration(matrix: sparse.csr_array, n: int) -> tuple[Complex, Complex]:
    """Eigenvalues and right eigenvectors by ARPACK, on a power of the matrix where that finds them all."""
    for power in POWERS:

        def advance(vector: NDArray[np.float64], power: int = power) -> NDArray[np.float64]:
            for _ in range(power):
                vector = matrix @ vector
            return vector

        operator = linalg.LinearOperator(matrix.shape, matvec=advance, dtype=np.float64)
        start = np.random.default_rng(0).random(matrix.shape[0])
        size = min(BASIS_TIMES * n + BASIS_MORE, matrix.shape[0])
        _, vectors = linalg.eigs(operator, k=n, which="LM", v0=start, ncv=size, tol=EIGENVALUE_ERROR)
        later = matrix @ vectors
        values = (vectors.conj() * later).sum(axis=0) / (np.abs(vectors) ** 2).sum(axis=0)
        if power == 1 or np.linalg.norm(later - vectors * values, axis=0).max() < RESIDUAL:
            break
    order = _order(values)
    return values[order], vectors[:, order]


def _order(values: Complex) -> NDArray[np.int64]:
    """Order by falling size; of a pair that goes round, the one with the angle above 0 first."""
    return np.lexsort((-values.imag, -np.round(np.abs(values), 9)))


def _smoothing_steps(eigenvalues: Complex) -> int:
    """Steps until `LEFT_OF_FASTEST` of the fastest process is left, 1 to `MOST_SMOOTHING`."""
    fastest = np.clip(np.abs(eigenvalues).min(initial=1), np.finfo(float).tiny, 1 - ROUND_OFF)
    return int(np.clip(np.log(LEFT_OF_FASTEST) / np.log(fastest), 1, MOST_SMOOTHING))


def _real_basis(stationary: NDArray[np.float64], vectors: Complex, values: Complex) -> NDArray[np.float64]:
    """Real columns that span a stationary vector and complex ones with their conjugates."""
    columns = [stationary]
    for value, vector in zip(values, vectors.T, strict=True):
        if value.imag > ROUND_OFF:
            columns += [vector.real, vector.imag]
        elif (
            value.imag >= -ROUND_OFF
        ):  # a real vector times a phase; others are the conjugate of the one before
            columns.append((vector / vector[np.argmax(np.abs(vector))]).real)
    return np.column_stack(columns)
