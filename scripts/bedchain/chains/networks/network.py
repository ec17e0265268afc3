# SPDX-License-Identifier: GPL-3.0-or-later
"""Network chain: states with declared contents, exits as absorbing states, a feed, and a cycle of matrices.

Everything after the matrix is shared with learned chains: `open_chain` (hold-up, residence times),
`matrix_analysis` (long-run density), `modes` (eigenvalues), `propagate` (expectation and Monte Carlo).
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains import matrix_analysis, propagate
from bedchain.chains.classes import closed_classes
from bedchain.chains.modes import Modes, slowest_modes
from bedchain.chains.open_chain import OpenChain, shut_in
from bedchain.errors import DataError

Array = NDArray[np.float64]
# exit of what reacts, which leaves the state's content as it is: that is of what carries it
REACTED = "reacted"


class State(NamedTuple):
    """A state of a network.

    Attributes
    ----------
    name : str
    content : float
        Declared content, an amount of any unit; NaN where it is not declared.
    height_m : float
        Height of its middle [m]; NaN where it has no place.
    zone : str
        Phase or zone, such as ``core``.
    """

    name: str
    content: float = float("nan")
    height_m: float = float("nan")
    zone: str = ""


@dataclass(frozen=True)
class Network:
    """A chain that was written down.

    Parameters
    ----------
    states : tuple of State
    cycle : tuple of (n_states + n_exits, n_states + n_exits) csr_array
        Row-stochastic matrices applied in turn, one a step; exits come last and keep what enters them.
    exits : tuple of str
        Names of the exits.
    feed : (n_states,) array
        What enters each state in a step; all 0 for a closed network.
    step_s : float
        Time of a step [s].

    Raises
    ------
    DataError
        A name is there twice, a content is not positive, a row does not sum to 1, an exit is no absorbing
        state, or a network has a feed and no exit, an exit and no feed, a feed and a cycle of many matrices,
        a state without way out, or an exit that what is fed cannot reach.
    """

    states: tuple[State, ...]
    cycle: tuple[sparse.csr_array, ...]
    exits: tuple[str, ...] = ()
    feed: Array = field(default_factory=lambda: np.zeros(0))
    step_s: float = 1.0

    def __post_init__(self) -> None:
        if not self.feed.size:
            object.__setattr__(self, "feed", np.zeros(len(self.states)))
        self._check_states()
        for matrix in {id(matrix): matrix for matrix in self.cycle}.values():
            self._check_rows(matrix)
        if self.feed.any() != bool(self.exits):
            lacking = "an exit" if self.feed.any() else "a feed"
            raise DataError(f"the network is open on one side only: add {lacking}, or close the other side")
        if self.feed.any():
            self._check_ways()

    @property
    def names(self) -> list[str]:
        """Names of the states."""
        return [state.name for state in self.states]

    @property
    def contents(self) -> Array:
        """Declared contents, (n_states,)."""
        return np.array([state.content for state in self.states])

    @property
    def is_open(self) -> bool:
        """Whether something enters and leaves."""
        return bool(self.exits)

    @property
    def placed(self) -> bool:
        """Whether all states have a height."""
        return all(np.isfinite(state.height_m) for state in self.states)

    @property
    def carries(self) -> bool:
        """Whether contents of the steady state are the declared ones: open, all declared, no reaction."""
        return self.is_open and REACTED not in self.exits and bool(np.isfinite(self.contents).all())

    @cached_property
    def product(self) -> sparse.csr_array:
        """Matrix of a whole cycle, (n_states + n_exits, n_states + n_exits)."""
        matrix = self.cycle[0]
        for later in self.cycle[1:]:
            matrix = sparse.csr_array(matrix @ later)
        return matrix

    @cached_property
    def open_chain(self) -> OpenChain:
        """The open network with its sums: hold-up, residence times, exit shares.

        Raises
        ------
        DataError
            The network is closed.
        """
        if not self.is_open:
            raise DataError("a closed network has no residence times: give it a feed and an exit")
        n, matrix = len(self.states), self.product
        return OpenChain(
            sparse.csr_array(matrix[:n, :n]), matrix[:n, n:].toarray(), self.feed, lag_s=self.step_s
        )

    def long_run(self, start: Array) -> Array:
        """Contents of a closed network that a start settles to, at the end of a cycle, (n_states,)."""
        return start.sum() * matrix_analysis.long_run_density(self.product, start)

    def modes(self, n: int) -> Modes:
        """Slowest processes of a closed network over a whole cycle."""
        return slowest_modes(self.product, n)

    def expected(self, start: Array, steps: int) -> Array:
        """Expected contents of states and exits at steps 0 to ``steps``, (steps + 1, n_states + n_exits).

        Parameters
        ----------
        start : (n_states,) array
            Contents at step 0; the feed does not count.
        steps : int
        """
        contents = np.zeros((steps + 1, self.product.shape[0]))
        contents[0, : len(self.states)] = start
        if len(self.cycle) == 1:
            return propagate.propagate(self.cycle[0], contents[0], steps)[:, 0]
        for step in range(steps):
            contents[step + 1] = contents[step] @ self.cycle[step % len(self.cycle)]
        return contents

    def walk(self, start: NDArray[np.integer], steps: int, rng: np.random.Generator) -> Iterator[NDArray]:
        """States of every particle at steps 0 to ``steps``, exits numbered after the states (Monte Carlo)."""
        if len(self.cycle) == 1:
            yield from propagate.walk(self.cycle[0], start, steps, rng)
            return
        now = np.array(start, np.int32)
        yield now
        for step in range(steps):
            *_, now = propagate.walk(self.cycle[step % len(self.cycle)], now, 1, rng)
            yield now

    def _check_states(self) -> None:
        names = [*self.names, *self.exits]
        for name in names:
            if names.count(name) > 1:
                raise DataError(f"the name {name} is there twice: give each state and exit its own")
        for state in self.states:
            if not (state.content > 0 or np.isnan(state.content)):
                raise DataError(f"state {state.name} has the content {state.content:g}: give a positive one")
        if self.is_open and len(self.cycle) > 1:
            raise DataError("an open network has a cycle of one matrix: its feed enters at every step")

    def _check_rows(self, matrix: sparse.csr_array) -> None:
        names = [*self.names, *self.exits]
        if matrix.shape != (len(names), len(names)):
            raise DataError(f"a matrix of shape {matrix.shape} for {len(names)} states and exits")
        if matrix.nnz and not matrix.data.min() >= 0:
            row = int(np.repeat(np.arange(len(names)), np.diff(matrix.indptr))[np.argmin(matrix.data)])
            raise DataError(f"state {names[row]} has a negative or undefined probability: correct it")
        sums = np.asarray(matrix.sum(axis=1)).ravel()
        if (wrong := np.flatnonzero(~(np.abs(sums - 1) <= propagate.ROW_SUM_TOLERANCE))).size:
            row = int(wrong[0])
            raise DataError(
                f"the probabilities out of {names[row]} sum to {sums[row]:.9g}, not 1: give all its moves, "
                "what stays too"
            )
        stays = matrix.diagonal()[len(self.states) :]
        if (leaks := np.flatnonzero(stays < 1)).size:
            raise DataError(f"the exit {self.exits[leaks[0]]} gives back what left: an exit has no moves")

    def _check_ways(self) -> None:
        n, matrix = len(self.states), self.product
        inside, leaving = sparse.csr_array(matrix[:n, :n]), matrix[:n, n:].toarray()
        if held := [states[0] for states in closed_classes(matrix) if states[0] < n]:
            name = self.names[min(held)]
            raise DataError(f"state {name} has no way out: what enters it stays for ever; lead it to an exit")
        reached = ~shut_in(sparse.csr_array(inside.T), self.feed > 0)
        for place, name in enumerate(self.exits):
            if not leaving[reached, place].any():
                raise DataError(
                    f"the exit {name} cannot be reached from the feed: lead a state to it, or leave it out"
                )
