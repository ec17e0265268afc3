# SPDX-License-Identifier: GPL-3.0-or-later
"""A scalar that particles carry on a chain: heat, or a tracer that reacts; first-order loss, and a gain.

Within a step each state's scalar decays by ``exp(-k lag)`` and gains at its rate, both exactly; then it moves
with the particles. What is lost is an exit of its own, so that `OpenChain` gives its steady state.
"""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains.open_chain import OpenChain
from bedchain.errors import DataError

Array = NDArray[np.float64]


def scalar_chain(matrix: sparse.csr_array, loss_1_s: Array, gain_1_s: Array, lag_s: float) -> OpenChain:
    """Open chain of a scalar: its exit is the loss, its feed the gain.

    Parameters
    ----------
    matrix : (n_states, n_states) csr_array
        Row-stochastic.
    loss_1_s : (n_states,) array
        First-order rate of loss in each state, of a reaction or of heat to the wall [1/s].
    gain_1_s : (n_states,) array
        Gain of each state, an amount in a second.
    lag_s : float
        Time of a step [s].

    Returns
    -------
    OpenChain
        `hold_up` is the amount in each state at the end of a step in the steady state. Its feed is what is
        left of the gain at the end of the step, moved once.

    Raises
    ------
    DataError
        A rate is negative, nothing is lost or gained, or what is gained in a state is never lost.
    """
    if min(loss_1_s.min(), gain_1_s.min()) < 0:
        raise DataError("a scalar has a negative rate of loss or gain: give rates of at least 0")
    if not loss_1_s.any():
        raise DataError("a scalar is lost nowhere: it would grow for ever; give one state a rate")
    kept = np.exp(-loss_1_s * lag_s)
    moves = sparse.csr_array(sparse.diags_array(kept) @ matrix)
    return OpenChain(
        moves, -np.expm1(-loss_1_s * lag_s)[:, None], gained(loss_1_s, gain_1_s, lag_s) @ matrix, lag_s
    )


def gained(loss_1_s: Array, gain_1_s: Array, lag_s: float) -> Array:
    """What is left at the end of a step of what each state gained in it, ``g (1 - exp(-k lag)) / k``."""
    small = loss_1_s * lag_s < np.finfo(float).eps
    return np.where(
        small, gain_1_s * lag_s, -gain_1_s * np.expm1(-loss_1_s * lag_s) / np.where(small, 1, loss_1_s)
    )


def scalar_over_time(chain: OpenChain, start: Array, steps: int) -> Array:
    """Amount in each state at steps 0 to ``steps`` from a start, (steps + 1, n_states)."""
    amounts = np.empty((steps + 1, len(start)))
    amounts[0] = start
    for step in range(steps):
        amounts[step + 1] = amounts[step] @ chain.moves + chain.feed
    return amounts


def lost_in_a_step(loss_1_s: Array, gain_1_s: Array, amounts: Array, lag_s: float) -> float:
    """Amount that is lost in a step of a state of amounts, of what was there and of what is gained in it."""
    of_amounts = float(amounts @ -np.expm1(-loss_1_s * lag_s))
    return of_amounts + float((gain_1_s * lag_s - gained(loss_1_s, gain_1_s, lag_s)).sum())


def effective_rate(matrix: sparse.csr_array, density: Array, loss_1_s: Array, lag_s: float) -> float:
    """Rate at which the whole loses a scalar that all particles gain evenly, in the steady state [1/s].

    Parameters
    ----------
    matrix : (n_states, n_states) csr_array
        Row-stochastic.
    density : (n_states,) array
        Share of the particles in each state [1]; states without any are left out.
    loss_1_s : (n_states,) array
        [1/s].
    lag_s : float
        [s].

    Returns
    -------
    float
        ``density @ loss`` where mixing is fast beside the loss; where the loss is fast, what mixing brings to
        the states that lose.
    """
    held = density > 0
    inside = sparse.csr_array(matrix[held][:, held])
    chain = scalar_chain(inside, loss_1_s[held], density[held], lag_s)
    return float(density[held].sum() / chain.hold_up().sum())
