# SPDX-License-Identifier: GPL-3.0-or-later
"""Estimators of the transition matrix, by hand, against loops, and their properties."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from bedchain.chains.counting import count_moves
from bedchain.chains.estimators import (
    ESTIMATORS,
    leak,
    transition_matrix,
    transition_matrix_with_openings,
    visited_density,
)
from bedchain.chains.matrix_analysis import long_run_density
from bedchain.errors import DataError
from bedchain.measures.batch import total_variation

ROUND_OFF = 1e-12


def paths(*particles: list[int]) -> np.ndarray:
    return np.array(particles, np.int32).T


def uneven_cell():
    """Cell 0 sends on 0.9 of what it holds when that is little (10), 0.1 when it is much (200)."""
    # two steps that do not follow each other; who is not in cell 0 waits in cell 2
    little = [[0, 1]] * 9 + [[0, 0]] + [[2, 2]] * 190
    much = [[0, 1]] * 20 + [[0, 0]] * 180
    cells = paths(*(one + two for one, two in zip(little, much, strict=True)))
    return count_moves(cells, 3, step_weights=np.array([1, 0, 1]))


def test_per_step_and_pooled_differ_where_occupancy_and_motion_are_linked():
    counts = uneven_cell()
    assert transition_matrix(counts, "per_step")[0, 1] == pytest.approx(0.5, abs=ROUND_OFF)
    assert transition_matrix(counts, "literal")[0, 1] == pytest.approx(0.5, abs=ROUND_OFF)
    assert transition_matrix(counts, "pooled")[0, 1] == pytest.approx(
        (0.9 * 1 + 0.1 * 20) / 21, abs=ROUND_OFF
    )
    assert transition_matrix(counts, "pooled")[0, 1] == pytest.approx(0.138, abs=5e-4)


def test_literal_leaks_what_it_says_and_the_rest_stays_put():
    # Cell 1 is occupied in one of two steps, cell 0 in both; nothing is ever in cell 2.
    counts = count_moves(paths([0, 1, 0], [0, 0, 0]), 3)
    assert ESTIMATORS["literal"](counts).toarray().tolist() == [[0.75, 0.25, 0], [0.5, 0, 0], [0, 0, 0]]
    assert transition_matrix(counts, "literal").toarray().tolist() == [
        [0.75, 0.25, 0],
        [0.5, 0.5, 0],
        [0, 0, 1],
    ]
    assert leak(counts) == pytest.approx(0.25 * 0.5)
    assert leak(counts, np.array([0.0, 0.0, 1.0])) == 1.0
    assert transition_matrix(counts, "per_step")[1, 0] == 1.0


def test_every_estimator_gives_rows_that_sum_to_one_on_random_frames():
    rng = np.random.default_rng(2)
    for n_cells in (1, 5, 40):
        cells = rng.integers(0, n_cells, (12, 25)).astype(np.int32)
        counts = count_moves(cells, n_cells + 3)
        for estimator in ESTIMATORS:
            matrix = transition_matrix(counts, estimator)
            assert np.abs(matrix.sum(axis=1) - 1).max() < ROUND_OFF and matrix.data.min() > 0
            assert matrix.shape == (n_cells + 3, n_cells + 3)


def test_agrees_with_naive_loops():
    rng = np.random.default_rng(5)
    cells = rng.integers(0, 6, (20, 15)).astype(np.int32)
    sums, steps = np.zeros((6, 6)), np.zeros(6)
    for now, later in zip(cells, cells[1:], strict=False):
        for i in range(6):
            if (now == i).any():
                steps[i] += 1
                for j in range(6):
                    sums[i, j] += ((now == i) & (later == j)).sum() / (now == i).sum()
    counts = count_moves(cells, 6)
    assert np.allclose(transition_matrix(counts, "per_step").toarray(), sums / steps[:, None], atol=ROUND_OFF)
    printed = sums / 19
    assert np.allclose(
        transition_matrix(counts, "literal").toarray(),
        printed + np.diag(1 - printed.sum(axis=1)),
        atol=ROUND_OFF,
    )


def test_pooled_keeps_the_mean_density_up_to_the_end_frames():
    rng = np.random.default_rng(7)
    cells = rng.integers(0, 9, (50, 40)).astype(np.int32)
    cells[-1] = cells[0]
    counts = count_moves(cells, 9)
    density = visited_density(counts)
    assert np.abs(density @ transition_matrix(counts) - density).max() < ROUND_OFF
    assert total_variation(long_run_density(transition_matrix(counts), density), density) < ROUND_OFF


def test_a_never_visited_cell_stays_put_and_shifts_no_number():
    counts = count_moves(paths([0, 3, 0, 3, 0]), 5)
    for estimator in ESTIMATORS:
        matrix, openings = transition_matrix_with_openings(counts, estimator)
        assert matrix.toarray()[[1, 2, 4]].tolist() == np.eye(5)[[1, 2, 4]].tolist()
        assert openings.never_left.tolist() == [1, 2, 4] and openings.closed_classes == 1
        assert matrix[0, 3] > 0 and openings.returned.size == 0


def test_an_unknown_estimator_names_those_that_exist():
    with pytest.raises(DataError, match="choose one of literal, per_step, pooled"):
        transition_matrix(uneven_cell(), "mean")


@given(
    arrays(np.int32, st.tuples(st.integers(2, 8), st.integers(1, 6)), elements=st.integers(0, 5)),
    st.sampled_from(sorted(ESTIMATORS)),
)
def test_rows_sum_to_one_and_particles_have_no_order(cells, estimator):
    matrix = transition_matrix(count_moves(cells, 6), estimator).toarray()
    assert matrix.sum(axis=1) == pytest.approx(np.ones(6), abs=ROUND_OFF) and matrix.min() >= 0
    turned = transition_matrix(count_moves(np.ascontiguousarray(cells[:, ::-1]), 6), estimator).toarray()
    assert turned == pytest.approx(matrix, abs=ROUND_OFF)


@given(arrays(np.int32, (4, 5), elements=st.integers(0, 3)), st.permutations(range(4)))
def test_pooled_needs_no_order_of_steps(cells, order):
    # the same steps one after the other in another order, each from a frame of its own
    def pooled(steps):
        frames = np.concatenate([cells[[step, (step + 1) % 4]] for step in steps])
        return transition_matrix(count_moves(frames, 4, step_weights=np.array([1, 0] * 3 + [1])), "pooled")

    assert pooled(order).toarray() == pytest.approx(pooled(range(4)).toarray(), abs=ROUND_OFF)
