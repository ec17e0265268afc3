# SPDX-License-Identifier: GPL-3.0-or-later
"""Open chains: exact residence times, contents over throughput, and chains learned from paths."""

from fractions import Fraction

import numpy as np
import pytest
from scipy import sparse

from bedchain.chains.counting import count_moves
from bedchain.chains.open_chain import OpenChain, open_chain
from bedchain.errors import DataError
from bedchain.trajectory.grid import OUTSIDE

EXACT = 1e-12
BINOMIAL = 4  # standard errors


def tanks(n, leave=0.25, lag_s=1.0):
    """Well-mixed tanks in a row: a share of each goes on in a step; what is fed is 3 a step."""
    moves = sparse.csr_array(np.diag(np.full(n, 1 - leave)) + np.diag(np.full(n - 1, leave), 1))
    exits = np.zeros((n, 1))
    exits[-1] = leave
    return OpenChain(moves, exits, np.eye(n)[0] * 3, lag_s)


def riser():
    """Core and annulus of three sections, a = 1/10 and b = 1/5, no reflection at the top.

    From the core to the annulus with a, else up; from the annulus to the core with b, else down (Harris,
    Thorpe and Davidson 2002, Chem. Eng. Sci. 57, 4779).
    """
    a, b, Q = 0.1, 0.2, np.zeros((6, 6))
    for i in range(3):
        core, annulus = i, 3 + i
        Q[core, annulus] += a
        if i < 2:
            Q[core, core + 1] = 1 - a
        Q[annulus, core] += b
        Q[annulus, annulus - 1 if i else 0] += 1 - b
    return OpenChain(sparse.csr_array(Q), (1 - Q.sum(axis=1))[:, None], np.eye(6)[0])


def test_tanks_in_a_row_have_their_known_mean_and_variance():
    chain = tanks(4, 0.25, 0.5)
    mean, variance = chain.residence()
    assert mean == pytest.approx(0.5 * 4 / 0.25, rel=EXACT)
    assert variance == pytest.approx(0.25 * 4 * 0.75 / 0.25**2, rel=EXACT)
    np.testing.assert_allclose(chain.hold_up(), 3 / 0.25, rtol=EXACT)
    assert chain.exit_shares() == pytest.approx([1], rel=EXACT)


def test_a_riser_has_the_exact_mean_and_variance_of_fractions():
    mean, variance = riser().residence()
    assert mean == pytest.approx(float(Fraction(3089, 729)), rel=EXACT)
    assert variance == pytest.approx(float(Fraction(3464248, 531441)), rel=EXACT)


@pytest.mark.parametrize("chain", [tanks(5, 0.3), riser()])
def test_contents_over_throughput_are_the_mean_residence(chain):
    mean, _ = chain.residence()
    assert chain.hold_up().sum() / chain.throughput == pytest.approx(mean / chain.lag_s, rel=EXACT)


def test_the_cumulative_distribution_has_the_mean_and_reaches_the_exit_shares():
    chain = riser()
    left = chain.left_by(400)
    assert (np.diff(left.sum(axis=1)) >= 0).all() and left[0].sum() == 0
    np.testing.assert_allclose(left[-1], chain.exit_shares(), atol=EXACT)
    assert (1 - left.sum(axis=1)).sum() == pytest.approx(chain.residence()[0], rel=1e-9)


def paths(chain, n_steps, seed=2):
    """Cells of particles that are fed and leave as a chain says, with one column for each of them."""
    rng, columns = np.random.default_rng(seed), []
    Q = np.column_stack((chain.moves.toarray(), chain.exits.sum(axis=1))).cumsum(axis=1)
    for start in range(-60, n_steps):
        for _ in range(rng.poisson(chain.throughput)):
            cells, state, frame = np.full(n_steps, OUTSIDE, np.int32), 0, start
            while state < len(Q) and frame < n_steps:
                if frame >= 0:
                    cells[frame] = state
                state, frame = int(np.searchsorted(Q[state], rng.random())), frame + 1
            columns.append(cells)
    return np.stack(columns, axis=1)


def test_a_chain_learned_from_paths_has_their_matrix_feed_and_residence():
    true = tanks(3, 0.3)
    cells = paths(true, 400)
    learned = open_chain([count_moves(cells, 3)], 1.0)
    visits = count_moves(cells, 3).visits
    for row, (p, q) in enumerate(zip(learned.moves.toarray(), true.moves.toarray(), strict=True)):
        assert np.abs(p - q).max() < BINOMIAL * np.sqrt(0.25 / visits[row])
    assert learned.throughput == pytest.approx(3, abs=BINOMIAL * np.sqrt(3 / 400))
    assert learned.residence()[0] == pytest.approx(10, rel=0.1)
    # conservation: what the feed holds up is what was there, but for the first and the last frame
    held = (cells >= 0).sum() / len(cells)
    assert learned.hold_up().sum() == pytest.approx(held, rel=0.05)


def test_a_cell_that_nothing_is_seen_to_leave_the_bed_from_holds_what_comes_there():
    cells = np.array([[0, OUTSIDE, 0], [1, 0, 0], [1, OUTSIDE, 1], [1, OUTSIDE, 1]], np.int32)
    chain = open_chain([count_moves(cells, 2)], 1.0)
    # of four moves from cell 0 two lead to cell 1, where all stay, one stays and one leaves
    assert chain.exit_shares() == pytest.approx([1 / 3, 2 / 3])
    assert chain.residence()[0] == pytest.approx(4 / 3 + 2 / 3)


def test_bad_chains_are_refused():
    with pytest.raises(DataError, match="no particle entered or none left"):
        open_chain([count_moves(np.zeros((4, 2), np.int32), 1)], 1.0)
    loop = OpenChain(sparse.csr_array(np.eye(2)), np.zeros((2, 1)), np.ones(2))
    with pytest.raises(DataError, match="no exit can be reached from state 0"):
        loop.residence()
    with pytest.raises(DataError, match="off a sum of 1"):
        OpenChain(sparse.csr_array(np.eye(2)), np.ones((2, 1)), np.ones(2))
    with pytest.raises(DataError, match="nothing enters"):
        OpenChain(sparse.csr_array(np.eye(2)), np.zeros((2, 1)), np.zeros(2))
    with pytest.raises(DataError, match="of the same states"):
        OpenChain(sparse.csr_array(np.eye(2)), np.zeros((3, 1)), np.ones(2))
