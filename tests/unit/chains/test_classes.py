# SPDX-License-Identifier: GPL-3.0-or-later
"""Communicating classes of a matrix, and closed ones opened again."""

import numpy as np
import pytest
from scipy import sparse

from bedchain.chains.classes import closed_classes
from bedchain.chains.counting import count_moves
from bedchain.chains.estimators import (
    transition_matrix,
    transition_matrix_with_openings,
)
from bedchain.chains.matrix_analysis import long_run_density


def paths(*particles: list[int]) -> np.ndarray:
    return np.array(particles, np.int32).T


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
