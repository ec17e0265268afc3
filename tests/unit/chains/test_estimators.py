# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from scipy import sparse

from bedchain.chains.classes import closed_classes
from bedchain.chains.counting import Counts, count_moves
from bedchain.chains.estimators import (
    ESTIMATORS,
    leak,
    transition_matrix,
    transition_matrix_with_openings,
    visited_density,
)
from bedchain.chains.matrix_analysis import long_run_density
from bedchain.chains.static import compare_estimators
from bedchain.errors import DataError
from bedchain.measures.batch import total_variation

ROUND_OFF = 1e-12


def paths(*particles: list[int]) -> np.ndarray:
    return np.array(particles, np.int32).T


def uneven_cell():
    """Cell 0 sends on 0.9 of what it holds when that is little (10), 0.1 when it is much (200)."""
    little = count_moves(paths(*[[0, 1]] * 9, [0, 0]), 2)
    much = count_moves(paths(*[[0, 1]] * 20, *[[0, 0]] * 180), 2)
    moves, shares = little.moves + much.moves, little.shares + much.shares
    return Counts(moves, shares, little.occupied + much.occupied, 2, 1)


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


def test_a_cell_entered_only_in_the_last_frame_sends_back_what_came():
    counts = count_moves(paths([0, 0, 1, 0, 2], [0, 1, 0, 1, 2], [0, 0, 0, 0, 2]), 3)
    matrix, openings = transition_matrix_with_openings(counts)
    assert matrix.toarray()[2].tolist() == pytest.approx([2 / 3, 1 / 3, 0])
    assert (
        openings.returned.tolist() == [2] and openings.never_left.size == 0 and openings.closed_classes == 1
    )
    kept, untouched = transition_matrix_with_openings(counts, "pooled", open_closed=False)
    assert kept.toarray()[2].tolist() == [0, 0, 1] and untouched.never_left.tolist() == [2]
    assert transition_matrix(counts, "literal").toarray()[2].tolist() == [0, 0, 1]


def test_a_closed_class_of_several_cells_is_opened_in_proportion_to_its_counts():
    # 0-1 is the bed; one particle leaves for 2-3 and goes to and fro there until the end.
    bed = [[0, 1] * 4] * 5
    counts = count_moves(paths(*bed, [0, 0, 2, 3, 2, 3, 2, 3]), 4)
    matrix, openings = transition_matrix_with_openings(counts)
    # Cell 2 was left 3 times for 3; the one arrival from 0, reversed, is the fourth.
    assert matrix.toarray()[2].tolist() == pytest.approx([0.25, 0, 0, 0.75])
    assert openings.returned.tolist() == [2] and openings.closed_classes == 1
    assert len(closed_classes(transition_matrix(counts, "pooled", open_closed=False))[0]) == 2
    trapped = long_run_density(
        transition_matrix(counts, "pooled", open_closed=False), np.array([1.0, 0, 0, 0])
    )
    free = long_run_density(matrix, np.array([1.0, 0, 0, 0]))
    assert trapped[:2].sum() == 0 and free[:2].sum() > 0.5


def test_a_chain_of_dead_ends_opens_in_turn():
    counts = count_moves(paths(*[[0, 0, 0, 0, 0]] * 9, [0, 0, 1, 2, 3]), 4)
    matrix, openings = transition_matrix_with_openings(counts)
    assert [c.tolist() for c in closed_classes(matrix)] == [[0, 1, 2, 3]]
    assert 3 in openings.returned and matrix[3, 2] == 1.0


def test_a_class_apart_from_the_start_is_kept_and_counted():
    matrix, openings = transition_matrix_with_openings(count_moves(paths([0, 1, 0], [2, 2, 2]), 3))
    assert openings.closed_classes == 2 and openings.returned.size == 0
    assert matrix[2, 2] == 1.0


def test_closed_classes_by_hand():
    matrix = sparse.csr_array(np.array([[0.5, 0.5, 0, 0], [0, 0, 1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]]))
    assert [c.tolist() for c in closed_classes(matrix)] == [[1, 2], [3]]


def test_report_of_each_estimator():
    counts = uneven_cell()
    table = compare_estimators(count_moves(paths([0, 1, 0, 1], [0, 0, 0, 0], [1, 1, 2, 1]), 4))
    assert set(table) == set(ESTIMATORS)
    assert table["literal"]["leak_1"] > 0 and table["pooled"]["leak_1"] == 0
    assert table["literal"]["row_sum_error_1"] == pytest.approx(2 / 3)
    assert table["per_step"]["row_sum_error_1"] < ROUND_OFF
    assert all(abs(row["mass_1"] - 1) < ROUND_OFF for row in table.values())
    assert all(0 <= row["long_run_total_variation_1"] <= 1 for row in table.values())
    with pytest.raises(DataError, match="choose one of literal, per_step, pooled"):
        transition_matrix(counts, "mean")
