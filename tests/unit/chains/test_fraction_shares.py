# SPDX-License-Identifier: GPL-3.0-or-later
"""Shares a fraction of a step later: a loop over the particles, and the matrices' products."""

import numpy as np
import pytest

from bedchain.chains.between_steps import learn_fractions, mixing_by_frame
from bedchain.chains.fraction_shares import learn_share_fractions
from bedchain.chains.registry import learn
from bedchain.errors import DataError
from bedchain.measures.mixing import Splits, side_shares
from bedchain.trajectory.frames import Frames
from bedchain.uncertainty.bands import kept_blocks, kept_steps
from made.frames import stirred

LAG, SPLITS = 4, Splits(0.025, 0.04)
ROUND_OFF = 1e-12


@pytest.fixture(scope="module")
def bed():
    return stirred()


def by_loop(cells, shares, lag, estimator, weights):
    """Mean share of where the particles of each cell are later, one particle at a time."""
    sums, number = np.zeros(shares.shape), np.zeros(shares.shape[1])
    for first, weight in enumerate(weights):
        now, later = cells[first], cells[first + lag]
        for cell in set(now[(now >= 0) & (later >= 0)].tolist()):
            there = later[(now == cell) & (later >= 0)]
            part = weight if estimator == "pooled" else weight / len(there)
            sums[:, cell] += part * sum(shares[:, place] for place in there)
            number[cell] += part * len(there)
    whole = np.full(number.size, weights.sum()) if estimator == "literal" else number
    known = whole > 0
    sums[:, known] /= whole[known]
    return sums + np.where(known, 1 - number / np.maximum(whole, 1e-300), 1) * shares


@pytest.mark.parametrize("estimator", ["literal", "per_step", "pooled"])
def test_shares_are_those_of_a_loop_over_the_particles(bed, estimator):
    frames, grid = bed
    cells = frames.cells.copy()[:30]
    cells[10:20, ::7] = -1  # those that are not there
    frames, shares = (
        Frames(frames.times_s[:30], frames.x_m[:30], frames.z_m[:30], cells),
        side_shares(grid, *SPLITS),
    )
    weights = [
        lambda lag, kept=kept: kept_steps(kept, 30 - lag) for kept in (np.ones(5, bool), *kept_blocks()[:2])
    ]
    counted = learn_share_fractions(
        frames, shares, LAG, estimator, lambda lag: np.stack([of_lag(lag) for of_lag in weights])
    )
    for of_set, of_lag in zip(counted, weights, strict=True):
        assert of_set.lag == LAG
        for lag in range(1, LAG):
            expected = by_loop(cells, shares, lag, estimator, of_lag(lag).astype(float))
            np.testing.assert_allclose(of_set.later(lag, shares), expected, atol=ROUND_OFF)


def test_curves_are_those_of_the_matrices(bed):
    frames, grid = bed
    chain, start = learn("static", frames, grid, LAG), frames.part(slice(0, 1))
    shares = learn_share_fractions(frames, side_shares(grid, *SPLITS), LAG)[0]
    curves = [
        mixing_by_frame(chain, fractions, start, SPLITS, 10)
        for fractions in (shares, learn_fractions(frames, grid.n_cells, LAG))
    ]
    np.testing.assert_allclose(*curves, atol=ROUND_OFF)


def test_a_lag_of_one_frame_has_none_and_an_unknown_estimator_is_refused(bed):
    frames, grid = bed
    shares = side_shares(grid, *SPLITS)
    assert [each.lag for each in learn_share_fractions(frames, shares, 1)] == [1]
    with pytest.raises(DataError, match="mean.*unknown"):
        learn_share_fractions(frames, shares, 3, "mean")
