# SPDX-License-Identifier: GPL-3.0-or-later
"""Propagation of densities and paths: known walks, dense powers, and their properties."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy import sparse

from bedchain.chains import propagate
from bedchain.errors import DataError

ROUND_OFF = 1e-12
# Monte Carlo against the exact mean, in standard errors; about 1 in 15 000 exceeds it by chance.
SIGMAS = 4.0


def reflecting_walk(n: int, p: float = 0.25) -> sparse.csr_array:
    """Lazy walk on a line, p each way; a refused move stays."""
    matrix = np.diag(np.full(n, 1 - 2 * p)) + np.diag(np.full(n - 1, p), 1) + np.diag(np.full(n - 1, p), -1)
    matrix[0, 0] += p
    matrix[-1, -1] += p
    return sparse.csr_array(matrix)


def ring(n: int, p: float) -> sparse.csr_array:
    """Advance with probability p, or stay."""
    return sparse.csr_array((1 - p) * np.eye(n) + p * np.roll(np.eye(n), 1, axis=1))


def random_matrix(seed: int, n: int = 30, density: float = 0.3) -> sparse.csr_array:
    rng = np.random.default_rng(seed)
    dense = rng.random((n, n)) * (rng.random((n, n)) < density) + np.diag(rng.random(n))
    return sparse.csr_array(dense / dense.sum(axis=1, keepdims=True))


def test_left_share_of_the_reflecting_walk():
    start = np.repeat([0.1, 0.0], 10)
    left = (start > 0).astype(float)
    after = propagate.propagate(reflecting_walk(20), start, [0, 200])
    assert after[0].tolist() == [start.tolist()]
    assert after[1, 0] @ left == pytest.approx(0.6181176003868688, abs=ROUND_OFF)
    back = propagate.expected_values(reflecting_walk(20), start[None], left[None], 200)
    assert back[200, 0, 0] == pytest.approx(0.6181176003868688, abs=ROUND_OFF)


def test_home_again_on_the_ring():
    after = propagate.propagate(ring(8, 0.75), np.eye(8)[0], 8)
    assert after[8, 0, 0] == pytest.approx(0.100128173828125, abs=ROUND_OFF)


def test_forward_and_backward_agree_with_dense_powers():
    rng = np.random.default_rng(3)
    for seed, n_obs in ((0, 1), (1, 2), (2, 3), (3, 4)):
        matrix, start, values = random_matrix(seed), rng.random((5, 30)), rng.random((n_obs, 30))
        forward = propagate.propagate(matrix, start, 12)
        backward = propagate.expected_values(matrix, start, values, 12)
        dense = start
        for step in range(13):
            assert np.allclose(forward[step], dense, rtol=0, atol=ROUND_OFF)
            mean = dense @ values.T / start.sum(axis=1, keepdims=True)
            assert np.allclose(backward[step], mean, rtol=0, atol=ROUND_OFF)
            dense = dense @ matrix.toarray()
        picked = propagate.propagate(matrix, start, [3, 3, 11])
        assert (picked == forward[[3, 3, 11]]).all()


def test_blocks_of_steps_change_nothing(monkeypatch):
    rng = np.random.default_rng(8)
    matrix, start, values = random_matrix(9), rng.random((2, 30)), rng.random((3, 30))
    whole = propagate.expected_values(matrix, start, values, 25)
    for steps_a_block in (1, 4, 26, 40):
        monkeypatch.setattr(propagate, "BLOCK_BYTES", 16 * 30 * steps_a_block)
        assert np.allclose(
            propagate.expected_values(matrix, start, values, 25), whole, rtol=0, atol=ROUND_OFF
        )


def test_a_million_steps_conserve_probability():
    start = np.random.default_rng(1).random((2, 30))
    for matrix in (random_matrix(4), ring(30, 0.3)):
        after = propagate.propagate(matrix, start, [1_000_000])[0]
        assert np.abs(after.sum(axis=1) - start.sum(axis=1)).max() < 1e-12
        assert after.min() >= 0


def test_an_empty_group_stays_empty_and_has_no_mean():
    start = np.array([[0.0] * 30, [1.0] * 30])
    assert propagate.propagate(random_matrix(1), start, [5])[0, 0].tolist() == [0.0] * 30
    means = propagate.expected_values(random_matrix(1), start, np.ones((1, 30)), 2)
    assert np.isnan(means[:, 0]).all() and np.allclose(means[:, 1], 1.0, atol=ROUND_OFF)


def test_cumulative_rows_end_at_exactly_one():
    for seed in range(5):
        matrix = random_matrix(seed, n=80)
        cdf = propagate.cumulative_rows(matrix)
        for low, high in zip(matrix.indptr, matrix.indptr[1:], strict=False):
            assert cdf[high - 1] == 1.0 and (np.diff(cdf[low:high]) >= 0).all()
            assert np.allclose(cdf[low:high], np.cumsum(matrix.data[low:high]), rtol=0, atol=ROUND_OFF)


def test_paths_agree_with_a_plain_search_and_repeat_by_seed():
    matrix = random_matrix(6)
    cdf = propagate.cumulative_rows(matrix)
    start = np.random.default_rng(2).integers(0, 30, 400)
    paths = propagate.simulate(matrix, start, 20, np.random.default_rng(7))
    assert (
        paths.dtype == np.int32
        and (paths == propagate.simulate(matrix, start, 20, np.random.default_rng(7))).all()
    )
    assert (paths != propagate.simulate(matrix, start, 20, np.random.default_rng(8))).any()
    rng = np.random.default_rng(7)
    now = start
    for step in range(20):
        draws = rng.random(400)
        rows = [slice(matrix.indptr[i], matrix.indptr[i + 1]) for i in now]
        now = [
            matrix.indices[r][np.searchsorted(cdf[r], u, side="right")]
            for r, u in zip(rows, draws, strict=True)
        ]
        assert paths[step + 1].tolist() == [int(i) for i in now]


def test_monte_carlo_agrees_with_the_exact_mean():
    matrix = reflecting_walk(20)
    n = 50_000
    start = np.random.default_rng(3).integers(0, 10, n)
    paths = propagate.simulate(matrix, start, 100, np.random.default_rng(4))
    exact = propagate.propagate(matrix, np.bincount(start, minlength=20) / n, [1, 10, 100])[:, 0]
    for share, step in zip(exact, (1, 10, 100), strict=True):
        counted = np.bincount(paths[step], minlength=20) / n
        error = np.sqrt(share * (1 - share) / n)
        assert (np.abs(counted - share) <= SIGMAS * error + 1e-15).all()


def test_an_unlikely_entry_is_neither_skipped_nor_favoured():
    tiny = 1e-3
    matrix = sparse.csr_array(np.array([[1 - tiny, tiny, 0], [0, 0, 1.0], [1.0, 0, 0]]))
    moved = propagate.simulate(matrix, np.zeros(400_000, int), 1, np.random.default_rng(5))[1]
    assert abs((moved == 1).mean() - tiny) < SIGMAS * np.sqrt(tiny / 400_000)
    assert (moved < 2).all()


def test_matrices_that_lose_particles_are_refused():
    bad = reflecting_walk(5).toarray()
    bad[3, 3] -= 1e-6
    with pytest.raises(DataError, match=r"row 3 .*1e-06 off a sum of 1"):
        propagate.propagate(sparse.csr_array(bad), np.ones(5), 1)
    with pytest.raises(DataError, match="square"):
        propagate.check_matrix(sparse.csr_array(np.ones((1, 2)) / 2))
    with pytest.raises(DataError, match="negative"):
        propagate.check_matrix(sparse.csr_array(np.array([[2.0, -1.0], [0, 1]])))
    with pytest.raises(DataError, match="must rise"):
        propagate.propagate(reflecting_walk(5), np.ones(5), [3, 1])


@st.composite
def chains(draw):
    """A small row-stochastic matrix in which some entries are nothing, and two groups of particles."""
    n = draw(st.integers(1, 6))
    dense = draw(arrays(float, (n, n), elements=st.sampled_from([0.0, 0.1, 0.5, 1.0, 3.0]))) + np.diag(
        draw(arrays(float, n, elements=st.sampled_from([0.25, 1.0])))
    )
    starts = draw(arrays(float, (2, n), elements=st.sampled_from([0.0, 1.0, 7.0])))
    return sparse.csr_array(dense / dense.sum(axis=1, keepdims=True)), starts


@given(chains(), st.integers(0, 12))
def test_particles_are_kept_and_groups_do_not_know_of_each_other(chain, steps):
    matrix, starts = chain
    both = propagate.propagate(matrix, starts, [steps])[0]
    assert both.sum(axis=1) == pytest.approx(starts.sum(axis=1), abs=ROUND_OFF) and both.min() >= 0
    added = propagate.propagate(matrix, 2 * starts[0] + starts[1], [steps])[0, 0]
    assert added == pytest.approx(2 * both[0] + both[1], abs=1e-10)


@given(chains(), st.integers(0, 6), st.integers(0, 6))
def test_chapman_and_kolmogorov_hold(chain, first, then):
    matrix, starts = chain
    at_once = propagate.propagate(matrix, starts, [first + then])[0]
    in_turn = propagate.propagate(matrix, propagate.propagate(matrix, starts, [first])[0], [then])[0]
    assert in_turn == pytest.approx(at_once, abs=1e-10)
    squared = sparse.csr_array(matrix @ matrix)
    two_by_two = propagate.propagate(squared, starts, [then])[0]
    assert two_by_two == pytest.approx(propagate.propagate(matrix, starts, [2 * then])[0], abs=1e-10)


@given(chains(), st.integers(0, 6))
def test_what_is_expected_forward_is_expected_backward(chain, steps):
    matrix, starts = chain
    starts = starts + 1.0  # no group is empty
    observable = np.arange(matrix.shape[0], dtype=float)[None]
    backward = propagate.expected_values(matrix, starts, observable, steps)[steps, :, 0]
    forward = propagate.propagate(matrix, starts, [steps])[0] @ observable[0] / starts.sum(axis=1)
    assert backward == pytest.approx(forward, abs=1e-10)
