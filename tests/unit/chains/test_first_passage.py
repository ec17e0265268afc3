# SPDX-License-Identifier: GPL-3.0-or-later
"""First passages beside deeptime, by hand, and by brute force."""

import numpy as np
import pytest
from deeptime.markov.tools import analysis
from scipy import sparse

from bedchain.chains import matrix_analysis
from bedchain.chains.first_passage import (
    entry_distribution,
    first_passage_steps,
    hitting_probability,
    mean_passage,
    mean_recurrence,
    passage_distribution,
    passage_moments,
)
from made.matrices import random_matrix, reflecting_walk

SOLVER = 1e-9
TARGET, AVOIDED = np.isin(np.arange(25), [3, 8]), np.isin(np.arange(25), [0, 20])


def stationary(matrix):
    return matrix_analysis.long_run_density(matrix, np.ones(matrix.shape[0]))


def test_first_passage_agrees_with_deeptime_and_by_hand():
    for seed in range(4):
        matrix = random_matrix(seed)
        target = np.zeros(25, bool)
        target[[3, 8]] = True
        theirs = analysis.mfpt(matrix.toarray(), [3, 8])
        ours = first_passage_steps(matrix, target)
        assert ours[~target] == pytest.approx(theirs[~target], rel=SOLVER) and (ours[target] == 0).all()
    up = first_passage_steps(reflecting_walk(5), np.arange(5) == 4)
    # From the wall, k cells up a walk of p = 1/4 each way: k (k + 1) / (2 p).
    assert up[0] == pytest.approx(4 * 5 * 2)


def test_first_passage_by_iteration_agrees_with_elimination(monkeypatch):
    matrix, target = random_matrix(5), np.arange(25) == 3
    direct = first_passage_steps(matrix, target)
    monkeypatch.setattr(matrix_analysis, "DIRECT_STATES", 1)
    assert first_passage_steps(matrix, target) == pytest.approx(direct, rel=1e-7)


def test_first_passage_is_infinite_where_the_target_may_be_missed():
    matrix = sparse.csr_array(np.array([[0.5, 0.25, 0.25, 0], [0, 1, 0, 0], [0, 0, 0, 1], [0, 0, 1, 0]]))
    assert first_passage_steps(matrix, np.arange(4) == 1).tolist() == [
        np.inf,
        0,
        np.inf,
        np.inf,
    ]
    assert first_passage_steps(matrix, np.arange(4) == 3).tolist() == [np.inf, np.inf, 1, 0]


def test_distribution_has_the_moments():
    for seed in range(3):
        matrix = random_matrix(seed)
        start = np.random.default_rng(seed).dirichlet(np.ones(25))
        arrived, step = passage_distribution(matrix, TARGET, start, 4000), np.arange(4001)
        mean, variance = passage_moments(matrix, TARGET)
        assert arrived.sum() == pytest.approx(1) and arrived[0] == start[TARGET].sum()
        assert arrived @ step == pytest.approx(start @ mean)
        # of the mixture: variances, and the variance of the means
        assert arrived @ step**2 == pytest.approx(start @ (variance + mean**2))


def test_distribution_is_that_of_powers_of_the_matrix():
    matrix = random_matrix(4).toarray()
    inner = np.where(TARGET, 0.0, 1.0)[:, None] * matrix * np.where(TARGET, 0.0, 1.0)
    out, start = matrix[:, TARGET].sum(axis=1), np.where(np.arange(25) == 1, 1.0, 0.0)
    naive = [0.0, *(start @ np.linalg.matrix_power(inner, k) @ out for k in range(6))]
    assert passage_distribution(sparse.csr_array(matrix), TARGET, start, 6) == pytest.approx(naive)


def test_residence_in_a_geometric_cell():
    # of the walk on five cells each inner one is left with 1/2 a step: mean 2, variance (1 - p) / p^2 = 2
    matrix = reflecting_walk(5)
    inside = np.arange(5) == 2
    entry = entry_distribution(matrix, stationary(matrix), inside)
    assert entry.tolist() == [0, 0, 1, 0, 0]
    mean, variance = passage_moments(matrix, ~inside)
    assert (entry @ mean, entry @ variance) == pytest.approx((2, 2))
    assert np.isnan(entry_distribution(sparse.csr_array(np.eye(5)), np.full(5, 0.2), inside)).all()


def test_entries_balance_exits_and_give_the_mean_residence():
    matrix, inside = random_matrix(6), np.arange(25) < 9
    density = stationary(matrix)
    entry = entry_distribution(matrix, density, inside)
    leaving = density[inside] @ matrix.toarray()[inside][:, ~inside].sum(axis=1)
    # contents over throughput
    assert entry @ first_passage_steps(matrix, ~inside) == pytest.approx(density[inside].sum() / leaving)


def test_hitting_probability_agrees_with_deeptime_and_by_hand():
    for seed in range(3):
        matrix = random_matrix(seed)
        theirs = analysis.committor(matrix.toarray(), np.flatnonzero(AVOIDED), np.flatnonzero(TARGET))
        assert hitting_probability(matrix, TARGET, AVOIDED) == pytest.approx(theirs, abs=SOLVER)
    # a gambler with even odds
    ends = np.arange(6)
    assert hitting_probability(reflecting_walk(6), ends == 5, ends == 0) == pytest.approx(ends / 5)
    apart = sparse.csr_array(np.eye(3))
    assert hitting_probability(apart, np.arange(3) == 0, np.arange(3) == 2).tolist() == [1, 0, 0]


def test_passage_between_sets_agrees_with_deeptime():
    matrix = random_matrix(2)
    density = stationary(matrix)
    theirs = analysis.mfpt(matrix.toarray(), np.flatnonzero(TARGET), np.flatnonzero(AVOIDED))
    assert mean_passage(matrix, density, AVOIDED, TARGET) == pytest.approx(theirs)
    assert mean_passage(sparse.csr_array(np.eye(25)), np.full(25, 0.04), AVOIDED, TARGET) == np.inf


def test_recurrence_is_a_step_and_the_way_back():
    matrix = random_matrix(5)
    density = stationary(matrix)
    weights = np.where(TARGET, density, 0) / density[TARGET].sum()
    back = 1 + (weights @ matrix) @ first_passage_steps(matrix, TARGET)
    assert mean_recurrence(density, TARGET) == pytest.approx(back)
    assert mean_recurrence(density, np.zeros(25, bool)) == np.inf
