# SPDX-License-Identifier: GPL-3.0-or-later
"""Dispersion by lag: walkers of known dispersion, and a naive loop."""

import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.measures.dispersion_by_lag import BLOCKS, dispersion_by_lag, lags_up_to
from bedchain.trajectory.synthetic import INTERVAL_S, free_walk
from made.frames import squared_displacement

MEMORY_S, SPEED_M_S = 0.1, 0.2
# of a variance of 1000 walkers, about sqrt(2 / 1000), and more for what they share over time
TOLERANCE = 0.08


def free_walkers(number: int, n_frames: int, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return free_walk(rng.normal(0, SPEED_M_S, number), n_frames, MEMORY_S, SPEED_M_S, rng)[0]


def test_walkers_without_walls_have_their_known_dispersion():
    x, z = free_walkers(1000, 81), free_walkers(1000, 81, 1)
    curve = dispersion_by_lag(x, z, INTERVAL_S)
    known = squared_displacement(curve.lags_s, MEMORY_S, SPEED_M_S) / (2 * curve.lags_s)
    np.testing.assert_allclose(curve.coefficient_m2_s, np.stack((known, known), axis=1), rtol=TOLERANCE)


def test_few_particles_are_counted_one_by_one():
    x, z = free_walkers(3, 12), free_walkers(3, 12, 1)
    curve = dispersion_by_lag(x, z, INTERVAL_S)
    assert curve.lags.tolist() == [1, 2, 3, 4, 5]
    for place, lag in enumerate(curve.lags):
        for axis, position in enumerate((x, z)):
            steps = np.array([position[t + lag] - position[t] for t in range(12 - lag)])
            assert curve.coefficient_m2_s[place, axis] == pytest.approx(steps.var() / (2 * lag * INTERVAL_S))
            kept = np.arange(12 - lag) * BLOCKS // (12 - lag) != 1
            expected = steps[kept].var() / (2 * lag * INTERVAL_S)
            assert curve.left_out_m2_s[1, place, axis] == pytest.approx(expected)


def test_a_common_drift_is_no_dispersion():
    drift = np.linspace(0, 1, 30)[:, None] + np.zeros(20)
    assert dispersion_by_lag(drift, drift, INTERVAL_S).coefficient_m2_s.max() < 1e-12


@pytest.mark.parametrize("longest", [1, 2, 31, 32, 33, 40, 1000])
def test_lags_are_few_and_rise_to_the_longest(longest):
    lags = lags_up_to(longest)
    assert lags[0] == 1 and lags[-1] == longest
    assert (np.diff(lags) > 0).all() and (np.diff(lags) <= np.maximum(1, lags[:-1] / 25)).all()
    assert lags.size <= 32 + 32 * np.log2(max(longest, 32) / 32) + 2


def test_two_frames_are_refused():
    with pytest.raises(DataError, match="2 frames hold no dispersion"):
        dispersion_by_lag(np.zeros((2, 5)), np.zeros((2, 5)), INTERVAL_S)
