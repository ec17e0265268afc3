# SPDX-License-Identifier: GPL-3.0-or-later
"""Observables of random chains beside deeptime and by brute force."""

import numpy as np
import pytest
from deeptime.markov.tools import analysis

from bedchain.chains.matrix_analysis import long_run_density
from bedchain.chains.observables import correlation, correlation_time, effective_samples, relaxation
from bedchain.chains.propagate import simulate
from made.matrices import random_matrix, reflecting_walk, with_states_apart


def case(seed):
    """A matrix, its density, and two observables."""
    matrix, rng = random_matrix(seed), np.random.default_rng(seed)
    return matrix, long_run_density(matrix, np.ones(25)), *rng.normal(size=(2, 25))


def test_correlation_and_relaxation_agree_with_deeptime():
    matrix, density, f, g = case(1)
    times = np.arange(6)
    for second in (None, g):
        theirs = analysis.correlation(matrix.toarray(), f, second, times=times)
        mean = (density @ f) * (density @ (f if second is None else second))
        assert correlation(matrix, density, f, second, 5) == pytest.approx(theirs - mean)
    start = np.random.default_rng(2).dirichlet(np.ones(25))
    theirs = analysis.relaxation(matrix.toarray(), start, f, times=times)
    assert relaxation(matrix, start, f, 5) == pytest.approx(theirs)


def test_correlation_time_is_the_sum_of_all_correlations():
    for matrix, density, f in (
        case(3)[:3],
        (with_states_apart(reflecting_walk(6)), np.insert(np.full(6, 1 / 6), [0, 2, 6], 0), np.arange(9.0)),
    ):
        rho = correlation(matrix, density, f, None, 3000)
        assert correlation_time(matrix, density, f) == pytest.approx(1 + 2 * rho[1:].sum() / rho[0], rel=1e-6)
    # of two states that change with p: rho = (1 - 2 p)^k
    walk = reflecting_walk(2, 0.1, 0.1)
    assert correlation_time(walk, np.full(2, 0.5), np.array([0.0, 1])) == pytest.approx(1.8 / 0.2)
    assert np.isnan(correlation_time(walk, np.full(2, 0.5), np.ones(2)))


def test_effective_samples_give_the_error_of_a_mean_over_time():
    matrix, density, n_steps = reflecting_walk(5), np.full(5, 0.2), 2000
    f, rng = np.arange(5.0), np.random.default_rng(4)
    paths = simulate(matrix, rng.integers(0, 5, 2000), n_steps - 1, rng)
    expected = f.var() / effective_samples(matrix, density, f, n_steps)
    # 2000 particles know a variance to 3 %
    assert f[paths].mean(axis=0).var() == pytest.approx(expected, rel=0.12)
