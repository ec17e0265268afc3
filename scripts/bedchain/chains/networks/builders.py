# SPDX-License-Identifier: GPL-3.0-or-later
"""Networks from what they are known by: probabilities of moves, rates, or flows between contents."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains.networks.network import Network, State
from bedchain.errors import DataError, guess

Array = NDArray[np.float64]
# a move: from a state, to a state or exit, and its probability, rate or flow
Move = tuple[str, str, float]

# what enters a state less what leaves it, over what goes through it: round-off of sums of flows
BALANCE_TOLERANCE = 1e-9
# least probability to stay that is round-off [1]
ROUND_OFF = 1e-12
# share of the fastest possible step where none is given
STEP_SHARE = 0.5


def from_edges(
    states: Sequence[State],
    exits: Sequence[str],
    edges: Iterable[Move],
    feed: Mapping[str, float] | None = None,
    step_s: float = 1.0,
) -> Network:
    """Network from the probabilities of its moves in a step.

    Parameters
    ----------
    states : sequence of State
    exits : sequence of str
        Names of the exits.
    edges : iterable of (from, to, probability)
        All of them, those of staying too: each state's sum to 1.
    feed : mapping of str to float, optional
        What enters in a step, by state.
    step_s : float
        Time of a step [s].

    Returns
    -------
    Network

    Raises
    ------
    DataError
        A name is unknown, or what `Network` refuses.
    """
    matrix = _moves(states, exits, edges).tolil()
    for place in range(len(states), matrix.shape[0]):
        matrix[place, place] = 1.0
    return Network(
        tuple(states), (sparse.csr_array(matrix),), tuple(exits), _feed(states, feed or {}), step_s
    )


def from_rates(
    states: Sequence[State],
    exits: Sequence[str],
    rates: Iterable[Move],
    feed: Mapping[str, float] | None = None,
    step_s: float | None = None,
) -> Network:
    """Network from first-order rates, ``P = I + L dt``; mean residence times do not depend on the step.

    Parameters
    ----------
    states : sequence of State
    exits : sequence of str
    rates : iterable of (from, to, rate)
        [1/s].
    feed : mapping of str to float, optional
        What enters in a second, by state.
    step_s : float, optional
        Time of a step [s]; without it half of the longest that is possible.

    Returns
    -------
    Network

    Raises
    ------
    DataError
        A name is unknown, a rate negative or too fast for the step, or what `Network` refuses.
    """
    moves = _moves(states, exits, rates)
    moves.setdiag(0)
    leaving = np.asarray(moves.sum(axis=1)).ravel()
    if not leaving.max(initial=0) > 0:
        raise DataError("no rate is above 0: nothing would move")
    step = STEP_SHARE / leaving.max() if step_s is None else step_s
    stays = 1 - step * leaving
    if (fast := int(np.argmin(stays))) < len(states) and stays[fast] < -ROUND_OFF:
        raise DataError(
            f"the rates out of {states[fast].name} sum to {leaving[fast]:g} 1/s, too fast for a step of "
            f"{step:g} s: take a step of at most {1 / leaving[fast]:.6g} s"
        )
    matrix = sparse.csr_array(step * moves + sparse.diags_array(np.maximum(stays, 0.0)))
    matrix.eliminate_zeros()
    enters = step * _feed(states, feed or {})
    return Network(tuple(states), (matrix,), tuple(exits), enters, step)


def from_fluxes(
    states: Sequence[State],
    exits: Sequence[str],
    fluxes: Iterable[Move],
    feed: Mapping[str, float] | None = None,
    step_s: float | None = None,
) -> Network:
    """Network from flows between contents, ``P_ij = F_ij dt / V_i``; the contents are its steady state.

    Parameters
    ----------
    states : sequence of State
        With declared contents.
    exits : sequence of str
    fluxes : iterable of (from, to, flow)
        Content in a second.
    feed : mapping of str to float, optional
        What enters in a second, by state.
    step_s : float, optional
        See `from_rates`.

    Returns
    -------
    Network

    Raises
    ------
    DataError
        A content is missing, the flows of a state do not balance, or what `from_rates` refuses.
    """
    listed = list(fluxes)
    for state in states:
        if not state.content > 0:
            raise DataError(f"state {state.name} has the content {state.content:g}: give a positive one")
    check_balance(states, exits, listed, feed or {})
    content = {state.name: state.content for state in states}
    rates = [(origin, target, flow / content[origin]) for origin, target, flow in listed]
    return from_rates(states, exits, rates, feed, step_s)


def check_balance(
    states: Sequence[State], exits: Sequence[str], fluxes: Sequence[Move], feed: Mapping[str, float]
) -> None:
    """Check that what enters each state leaves it.

    Raises
    ------
    DataError
        It does not; the message names the state and the surplus.
    """
    flows = _moves(states, exits, fluxes)
    enters = np.asarray(flows.sum(axis=0)).ravel()[: len(states)] + _feed(states, feed)
    leaves = np.asarray(flows.sum(axis=1)).ravel()[: len(states)]
    surplus = enters - leaves
    through = np.maximum(enters, leaves)
    wrong = np.flatnonzero(np.abs(surplus) > BALANCE_TOLERANCE * through)
    if wrong.size:
        place = int(wrong[np.argmax(np.abs(surplus[wrong]))])
        raise DataError(
            f"the flows of {states[place].name} do not balance: {enters[place]:.9g} enters and "
            f"{leaves[place]:.9g} leaves, a surplus of {surplus[place]:.6g}; correct a flow"
        )


def _moves(states: Sequence[State], exits: Sequence[str], moves: Iterable[Move]) -> sparse.csr_array:
    """Values of moves by state and exit, (n_states + n_exits, n_states + n_exits), summed where repeated."""
    names = [*(state.name for state in states), *exits]
    place = {name: number for number, name in enumerate(names)}
    rows, columns, values = [], [], []
    for origin, target, value in moves:
        for name in (origin, target):
            if name not in place:
                raise DataError(f"{name} is no state and no exit{guess(name, place)}")
        if place[origin] >= len(states):
            raise DataError(f"the exit {origin} gives back what left: an exit has no moves")
        if not (value >= 0 and np.isfinite(value)):
            raise DataError(f"from {origin} to {target} goes {value:g}: give a number of at least 0")
        rows.append(place[origin])
        columns.append(place[target])
        values.append(float(value))
    return sparse.csr_array(
        sparse.coo_array((np.array(values), (rows, columns)), shape=(len(names), len(names)))
    )


def _feed(states: Sequence[State], feed: Mapping[str, float]) -> Array:
    """What enters each state, (n_states,)."""
    names = [state.name for state in states]
    for name, amount in feed.items():
        if name not in names:
            raise DataError(f"the feed names {name}, which is no state{guess(name, names)}")
        if not (amount > 0 and np.isfinite(amount)):
            raise DataError(f"the feed of {name} is {amount:g}: give a positive one")
    return np.array([float(feed.get(name, 0.0)) for name in names])
