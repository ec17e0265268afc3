# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of networks see what they look for."""

import numpy as np
import pytest

from bedchain.chains.networks import checks
from bedchain.chains.networks.network import Network, State
from bedchain.chains.networks.page import PageChain
from bedchain.chains.networks.riser import Exchange, riser_steps


@pytest.fixture(scope="module")
def chain():
    return riser_steps(4, Exchange(0, 0, 0.2, 0.3, 0.2))


def test_a_right_network_passes(chain):
    assert checks.row_sum_error(chain) <= 1e-15
    assert max(checks.hold_up_error(chain), checks.danckwerts_error(chain)) < 1e-12


def test_wrong_contents_are_seen(chain):
    states = (State("core 1", 2 * chain.states[0].content), *chain.states[1:])
    wrong = Network(states, chain.cycle, chain.exits, chain.feed)
    assert checks.hold_up_error(wrong) == pytest.approx(0.5)
    assert checks.danckwerts_error(wrong) > 0.1


def test_monte_carlo_is_within_its_error_and_another_chain_is_not(chain, monkeypatch):
    page = PageChain("riser", chain, None, {})
    assert 1 < checks.monte_carlo_sigmas(page, 30, 4000, 1) < 6
    other = riser_steps(4, Exchange(0, 0, 0.3, 0.3, 0.2))
    monkeypatch.setattr(Network, "walk", lambda self, *rest: other.open_chain and walked(other, *rest))
    assert checks.monte_carlo_sigmas(page, 30, 4000, 1) > 8


def walked(chain, start, steps, rng):
    """Paths of another chain."""
    now = np.array(start)
    rows = chain.product.toarray().cumsum(axis=1)
    yield now
    for _ in range(steps):
        now = (rows[now] < rng.random(now.size)[:, None]).sum(axis=1)
        yield now


def test_a_start_is_the_pages_or_the_feed_or_the_contents(chain):
    assert checks.start_of(PageChain("a", chain, None, {})).tolist() == [1, *[0] * 7]
    assert checks.start_of(PageChain("a", chain, np.ones(8), {})).tolist() == [1] * 8
