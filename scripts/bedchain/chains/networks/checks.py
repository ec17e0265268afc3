# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that every network passes: rows, contents, Danckwerts, and Monte Carlo within its binomial error."""

import numpy as np
from numpy.typing import NDArray

from bedchain.chains.networks.network import Network
from bedchain.chains.networks.page import PageChain

Array = NDArray[np.float64]
# counts below this are too few for a normal error: their deviations are not looked at
FEWEST = 25
# moments at which Monte Carlo and expectation are compared
MOMENTS = 40


def row_sum_error(network: Network) -> float:
    """Largest deviation of a row's sum from 1, over all matrices [1]."""
    return max(float(np.abs(np.asarray(matrix.sum(axis=1)) - 1).max()) for matrix in network.cycle)


def hold_up_error(network: Network) -> float:
    """Largest relative deviation of the hold-up from the declared contents [1]."""
    return float(np.abs(network.open_chain.hold_up() / network.contents - 1).max())


def danckwerts_error(network: Network) -> float:
    """Relative deviation of the mean residence time from declared contents over throughput [1].

    Danckwerts, Chem. Eng. Sci. 2 (1953) 1-13: they are equal where nothing diffuses back through inlet or
    outlet.
    """
    chain = network.open_chain
    by_contents = chain.lag_s * network.contents.sum() / chain.throughput
    return abs(chain.residence()[0] / by_contents - 1)


def monte_carlo_sigmas(chain: PageChain, steps: int, particles: int, seed: int) -> float:
    """Largest deviation of a Monte Carlo from the expectation, in binomial standard errors [1].

    Parameters
    ----------
    chain : PageChain
    steps : int
        Looked at are `MOMENTS` of them, and of each state and exit.
    particles : int
        Of the start, or of the feed.
    seed : int

    Returns
    -------
    float
        The largest of some hundred normal numbers: about 3.
    """
    network = chain.network
    amount = network.feed if network.is_open else start_of(chain)
    share = amount / amount.sum()
    rng = np.random.default_rng(seed)
    begin = rng.choice(len(share), particles, p=share)
    exact, worst = network.expected(share, steps), 0.0
    # the draw of the start is part of the error: shares of the whole, not of those that started in a state
    for step, states in enumerate(network.walk(begin, steps, rng)):
        if step and (step % max(1, steps // MOMENTS) == 0 or step == steps):
            seen = np.bincount(states, minlength=exact.shape[1])
            chance = exact[step]
            known = particles * np.minimum(chance, 1 - chance) > FEWEST
            error = np.sqrt(particles * chance * (1 - chance))[known]
            worst = max(worst, float(np.abs((seen - particles * chance)[known] / error).max(initial=0.0)))
    return worst


def start_of(chain: PageChain) -> Array:
    """What a chain starts with: its start, 1 by its feed, its contents, or the first state."""
    if chain.start is not None:
        return chain.start
    if chain.network.is_open:
        return chain.network.feed / chain.network.feed.sum()
    if np.isfinite(chain.network.contents).all():
        return chain.network.contents
    return np.eye(len(chain.network.states))[0]
