# SPDX-License-Identifier: GPL-3.0-or-later
"""Builders of networks: the same chain by probabilities, rates and flows, and pages that cannot be."""

import numpy as np
import pytest

from bedchain.chains.networks.builders import from_edges, from_fluxes, from_rates
from bedchain.chains.networks.network import State
from bedchain.errors import DataError

STATES = (State("a", 2.0), State("b", 4.0))
FLOWS = [("a", "b", 3.0), ("b", "a", 2.0), ("b", "out", 1.0)]
FEED = {"a": 1.0}


def test_probabilities_rates_and_flows_give_the_same_chain():
    edges = [("a", "a", 0.85), ("a", "b", 0.15), ("b", "a", 0.05), ("b", "out", 0.025), ("b", "b", 0.925)]
    rates = [("a", "b", 1.5), ("b", "a", 0.5), ("b", "out", 0.25)]
    chains = [
        from_edges(STATES, ["out"], edges, {"a": 0.1}, 0.1),
        from_rates(STATES, ["out"], rates, FEED, 0.1),
        from_fluxes(STATES, ["out"], FLOWS, FEED, 0.1),
    ]
    for chain in chains:
        np.testing.assert_allclose(chain.product.toarray(), chains[0].product.toarray(), atol=1e-15)
        np.testing.assert_allclose(chain.open_chain.hold_up(), [2, 4])


def test_mean_and_contents_do_not_depend_on_the_step():
    means = [
        from_fluxes(STATES, ["out"], FLOWS, FEED, step).open_chain.residence()[0]
        for step in (0.6, 0.01, None)
    ]
    np.testing.assert_allclose(means, 6.0)


@pytest.mark.parametrize(
    ("build", "moves", "feed", "message"),
    [
        (from_edges, [("a", "a", 0.9), ("b", "out", 1.0)], FEED, "out of a sum to 0.9"),
        (from_edges, [("a", "c", 1.0)], FEED, "c is no state and no exit"),
        (from_rates, [("a", "b", 1.5), ("b", "out", 3.0)], FEED,
         "out of b sum to 3 1/s, too fast for a step of 0.5 s: take a step of at most 0.333333 s"),
        (from_rates, [("a", "b", -1.0)], FEED, "from a to b goes -1"),
        (from_rates, [("out", "b", 1.0)], FEED, "the exit out gives back"),
        (from_rates, [("a", "b", 1.0), ("b", "out", 1.0)], {"a": 0.0}, "the feed of a is 0"),
        (from_rates, [("a", "b", 1.0), ("b", "out", 1.0)], {"x": 1.0}, "the feed names x"),
        (from_rates, [("a", "b", 0.0)], FEED, "nothing would move"),
        (from_fluxes, [("a", "b", 1.0), ("b", "out", 1.5)], FEED,
         "flows of b do not balance: 1 enters and 1.5 leaves, a surplus of -0.5"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_with_its_state(build, moves, feed, message):
    with pytest.raises(DataError, match=message):
        build(STATES, ["out"], moves, feed, 0.5)


@pytest.mark.parametrize("content", [0.0, -1.0, float("nan")])
def test_flows_need_contents(content):
    with pytest.raises(DataError, match="state b has the content"):
        from_fluxes((STATES[0], State("b", content)), ["out"], FLOWS, FEED)
