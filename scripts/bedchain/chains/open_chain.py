# SPDX-License-Identifier: GPL-3.0-or-later
"""Open chains: particles enter by a feed and leave by exits, which absorb them; hold-up and residence times.

A step moves what is in the states by Q and to the exits by R; rows of both sum to 1. What the feed b brings
in a step is first seen at the end of it, so that a particle seen k times was k steps inside, on average over
the moments within a step at which it came and went. The sums are those of an absorbing chain (Kemeny and
Snell 1960, Finite Markov Chains, chapter 3): visits ``b (I - Q)^-1``, moments of the steps until absorption
``(I - Q) m1 = 1`` and ``(I - Q) m2 = 2 m1 - 1``, exit shares ``(I - Q)^-1 R``.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import splu

from bedchain.chains.counting import Counts
from bedchain.chains.propagate import ROW_SUM_TOLERANCE
from bedchain.errors import DataError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class OpenChain:
    """A chain with a feed and exits.

    Parameters
    ----------
    moves : (n_states, n_states) csr_array
        Q: probability to be in each state after a step.
    exits : (n_states, n_exits) array
        R: probability to have left by each exit.
    feed : (n_states,) array
        b: what enters in each state in a step, a number of particles or any amount.
    lag_s : float
        Length of a step [s].
    """

    moves: sparse.csr_array
    exits: Array
    feed: Array
    lag_s: float = 1.0

    def __post_init__(self) -> None:
        n_states = self.moves.shape[0]
        if self.moves.shape[1] != n_states or len(self.exits) != n_states or self.feed.shape != (n_states,):
            raise DataError(
                f"an open chain of {self.moves.shape} moves, {self.exits.shape} exits and {self.feed.shape} "
                "feeds: they must be of the same states"
            )
        if min(self.moves.data.min(initial=0), self.exits.min(initial=0), self.feed.min(initial=0)) < 0:
            raise DataError("an open chain holds a negative probability or feed")
        error = np.abs(self.moves.sum(axis=1) + self.exits.sum(axis=1) - 1)
        if error.size and error.max() > ROW_SUM_TOLERANCE:
            row = int(error.argmax())
            raise DataError(f"row {row} of an open chain is {error[row]:.3g} off a sum of 1 with its exits")
        if not self.feed.sum() > 0:
            raise DataError("nothing enters the open chain: it has no residence time")

    @property
    def throughput(self) -> float:
        """What enters in a step [1]."""
        return float(self.feed.sum())

    def hold_up(self) -> Array:
        """Contents of the states in the steady state, ``b (I - Q)^-1``, (n_states,)."""
        return np.asarray(splu(self._left()).solve(self.feed, trans="T"))

    def moments(self) -> tuple[Array, Array]:
        """Mean, and mean square, of the steps from each state until leaving, two (n_states,) [steps]."""
        factors = splu(self._left())
        first = factors.solve(np.ones(len(self.feed)))
        return first, factors.solve(2 * first - 1)

    def residence(self) -> tuple[float, float]:
        """Mean [s] and variance [s2] of the residence time of what is fed."""
        weight = self.feed / self.feed.sum()
        first, second = (float(weight @ moment) for moment in self.moments())
        return self.lag_s * first, self.lag_s**2 * (second - first**2)

    def residence_by_exit(self) -> Array:
        """Mean [s] and variance [s2] of the residence time of what leaves by each exit, (n_exits, 2).

        With h the probability to leave by the exit from each state, ``(I - Q) x = h`` is the mean of the
        steps where that exit is taken, 0 else, and ``(I - Q) y = 2 x - h`` that of their squares.
        """
        factors, weight = splu(self._left()), self.feed / self.feed.sum()
        rows = []
        for leaving in self.exits.T:
            chance = factors.solve(leaving)
            first = factors.solve(chance)
            second = factors.solve(2 * first - chance)
            with np.errstate(invalid="ignore", divide="ignore"):  # of an exit that nothing takes
                mean, square = weight @ first / (weight @ chance), weight @ second / (weight @ chance)
            rows.append((self.lag_s * mean, self.lag_s**2 * (square - mean**2)))
        return np.array(rows)

    def left_by(self, steps: int) -> Array:
        """F: share of what is fed that has left by each exit after 0, 1, ... steps, (steps + 1, n_exits)."""
        now, left = self.feed / self.feed.sum(), np.zeros((steps + 1, self.exits.shape[1]))
        for step in range(1, steps + 1):
            left[step] = left[step - 1] + now @ self.exits
            now = now @ self.moves
        return left

    def exit_shares(self) -> Array:
        """Share of what is fed that leaves by each exit in the end, (n_exits,)."""
        return np.asarray(self.hold_up() @ self.exits / self.feed.sum())

    def _left(self) -> sparse.csc_array:
        """I - Q.

        Raises
        ------
        DataError
            From a state no exit is in reach, so that a particle stays for ever.
        """
        if (shut := shut_in(self.moves, self.exits.sum(axis=1) > 0)).any():
            state = int(np.flatnonzero(shut)[0])
            raise DataError(f"no exit can be reached from state {state}: what enters it stays for ever")
        return sparse.csc_array(sparse.eye_array(len(self.feed)) - self.moves)


# exits of a learned chain: out of the bed, or into a cell from which nothing was seen to leave the bed
LEARNED_EXITS = ("outside", "held")


def open_chain(parts: Sequence[Counts], lag_s: float) -> OpenChain:
    """Open chain of pooled counts, with what was inserted as its feed.

    Parameters
    ----------
    parts : sequence of Counts
        Of windows of the same cells and lag, such as the blocks of one.
    lag_s : float
        Length of a step [s].

    Returns
    -------
    OpenChain
        Its feed is in particles a step, its exits are `LEARNED_EXITS`. From some cells no counted moves lead
        out of the bed; what comes there is held, after a step. Where that is more than next to nothing, the
        window is too short for a residence time.

    Raises
    ------
    DataError
        No particle was inserted, or none left.
    """
    moves = sparse.csr_array(sum((part.moves for part in parts[1:]), parts[0].moves))
    none = np.zeros(moves.shape[0], np.int64)
    lost, inserted = none.copy(), none.copy()
    for part in parts:
        lost += none if part.lost is None else part.lost
        inserted += none if part.inserted is None else part.inserted
    if not (lost.any() and inserted.any()):
        raise DataError(
            "no particle entered or none left in the window, so that it has no residence time: take a longer "
            "window, or outside: refuse for a closed bed"
        )
    total = np.asarray(moves.sum(axis=1)).ravel() + lost
    shut = shut_in(moves, lost > 0)
    divisor = np.where(shut, 0.0, 1.0 / np.maximum(total, 1))
    rows = sparse.csr_array(sparse.diags_array(divisor) @ moves)
    rows.eliminate_zeros()
    left = np.clip(1.0 - np.asarray(rows.sum(axis=1)).ravel(), 0.0, 1.0)
    exits = np.column_stack((np.where(shut, 0.0, left), shut.astype(float)))
    return OpenChain(rows, exits, inserted / sum(part.steps for part in parts), lag_s)


def shut_in(moves: sparse.csr_array, leaving: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """States from which no state that can be left is in reach, (n_states,)."""
    reaches, link = np.asarray(leaving), sparse.csr_array(moves > 0).astype(np.int64)
    while True:
        more = reaches | (link @ reaches.astype(np.int64) > 0)
        if (more == reaches).all():
            return np.asarray(~reaches)
        reaches = more
