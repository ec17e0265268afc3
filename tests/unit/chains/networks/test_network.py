# SPDX-License-Identifier: GPL-3.0-or-later
"""A network: what it refuses, and that its sums are those of plain powers of its matrix."""

import numpy as np
import pytest
from scipy import sparse

from bedchain.chains.networks.network import REACTED, Network, State
from bedchain.errors import DataError

A, B = State("a", 2.0), State("b", 1.0)


def network(rows, states=(A, B), exits=("out",), feed=(1.0, 0.0), repeat=1):
    matrix = sparse.csr_array(np.array(rows, float))
    return Network(tuple(states), (matrix,) * repeat, tuple(exits), np.array(feed, float))


GOOD = [[0.5, 0.5, 0], [0, 0, 1], [0, 0, 1]]


def test_sums_of_an_open_network_are_those_of_powers_of_its_matrix():
    chain = network([[0.5, 0.3, 0.2], [0.1, 0.6, 0.3], [0, 0, 1]])
    inside = np.array([[0.5, 0.3], [0.1, 0.6]])
    powers = [np.linalg.matrix_power(inside, k) for k in range(300)]
    np.testing.assert_allclose(chain.open_chain.hold_up(), sum(np.array([1, 0]) @ power for power in powers))
    steps = np.arange(1, 301)
    leaving = np.array([np.array([1, 0]) @ power @ [0.2, 0.3] for power in powers])
    mean, variance = chain.open_chain.residence()
    assert mean == pytest.approx(steps @ leaving) and variance == pytest.approx(steps**2 @ leaving - mean**2)


def test_residence_by_exit_is_that_of_powers():
    rows = [[0.5, 0.3, 0.2, 0], [0.1, 0.5, 0, 0.4], [0, 0, 1, 0], [0, 0, 0, 1]]
    chain = network(rows, exits=("up", "down")).open_chain
    inside, steps = np.array(rows)[:2, :2], np.arange(1, 301)
    now = [np.array([1, 0]) @ np.linalg.matrix_power(inside, k) for k in range(300)]
    for place, leaving in enumerate(np.array(rows)[:2, 2:].T):
        out = np.array([state @ leaving for state in now])
        mean = steps @ out / out.sum()
        expected = mean, steps**2 @ out / out.sum() - mean**2
        np.testing.assert_allclose(chain.residence_by_exit()[place], expected)
        assert chain.exit_shares()[place] == pytest.approx(out.sum())


def test_a_cycle_is_applied_in_turn_by_expectation_and_by_walk():
    swap, stay = sparse.csr_array([[0.0, 1.0], [1.0, 0.0]]), sparse.csr_array(np.eye(2))
    chain = Network((A, B), (swap, stay))
    assert chain.expected(np.array([1.0, 0]), 4)[:, 0].tolist() == [1, 0, 0, 1, 1]
    walked = [int(states[0]) for states in chain.walk(np.array([0]), 4, np.random.default_rng(0))]
    assert walked == [0, 1, 1, 0, 0]
    np.testing.assert_allclose(chain.product.toarray(), swap.toarray())


def test_what_reacts_leaves_the_declared_contents_out_of_the_checks():
    rows = [[0.5, 0.3, 0.2], [0.0, 0.5, 0.5], [0, 0, 1]]
    assert network(rows).carries and not network(rows, exits=(REACTED,)).carries
    assert not network(rows, states=(A, State("b"))).carries


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"rows": [[0.5, 0.4, 0], [0, 0, 1], [0, 0, 1]]}, "out of a sum to 0.9, not 1"),
        ({"rows": [[1.5, -0.5, 0], [0, 0, 1], [0, 0, 1]]}, "state a has a negative"),
        ({"rows": [[0.5, 0.5, 0], [0, 0, 1], [0.5, 0, 0.5]]}, "the exit out gives back"),
        ({"rows": [[0.5, 0.5, 0], [0, 1, 0], [0, 0, 1]]}, "state b has no way out"),
        ({"states": (A, State("b", 0.0))}, "state b has the content 0"),
        ({"states": (A, A)}, "a is there twice"),
        ({"feed": (0, 0)}, "open on one side only: add a feed"),
        ({"exits": (), "rows": [[0.5, 0.5], [0.5, 0.5]]}, "open on one side only: add an exit"),
        ({"repeat": 2}, "cycle of one matrix"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused(change, message):
    with pytest.raises(DataError, match=message):
        network(**({"rows": GOOD} | change))


def test_an_exit_that_the_feed_cannot_reach_is_refused():
    rows = [[0, 0.0, 1, 0], [0, 0.5, 0, 0.5], [0, 0, 1, 0], [0, 0, 0, 1]]
    with pytest.raises(DataError, match="the exit side cannot be reached"):
        network(rows, exits=("out", "side"))


def test_a_closed_network_has_no_residence_times():
    with pytest.raises(DataError, match="closed network"):
        _ = Network((A, B), (sparse.csr_array(np.eye(2)),)).open_chain
