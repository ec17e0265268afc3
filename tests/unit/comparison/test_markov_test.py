# SPDX-License-Identifier: GPL-3.0-or-later
"""The Markov test on particles that are Markov, and on particles that are not."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from bedchain.chains import registry
from bedchain.comparison.forecasts import count_sides, counted
from bedchain.comparison.markov_test import check_model, counted_rows, doubled_lags, markovian
from bedchain.errors import DataError
from bedchain.trajectory.grid import Grid
from made.frames import framed, stirred

# a ring of five: one of four would swing between two halves for ever
GRID = Grid(0.05, 0.01, 5, 1)
SPLITS = (0.02, 0.005)


def walkers(turning: float, seed: int):
    """Particles that go round the ring, in either sense, and turn with some probability."""
    rng = np.random.default_rng(seed)
    turned = np.where(rng.random((80, 2000)) < turning, -1, 1)
    turned[0] = rng.choice([-1, 1], 2000)
    cells = (rng.integers(0, 5, 2000) + np.cumsum(np.cumprod(turned, axis=0), axis=0)) % 5
    return framed(cells, GRID)


def rows_of(frames, name, memory=1.0):
    """Rows by quantity, part and time, at a lag of one frame."""
    sides = count_sides(frames, *SPLITS, [1, 5])
    relearner = partial(registry.relearner, name, frames, GRID)
    rows, first = check_model(name, relearner, frames, sides, [1], memory, lambda chain: chain.matrix.sum(1))
    assert first.whole.further == pytest.approx(1) and len(first.left_out.further) == (
        0 if memory > 16 else 5
    )
    return {(row["quantity"], row["part"], row.get("time_s")): row for row in rows}


def test_lags_double_while_the_window_holds_five_steps():
    assert doubled_lags(2, 81) == [2, 4, 8, 16]
    assert doubled_lags(2, 80) == [2, 4, 8]
    assert doubled_lags(30, 40) == [30]


def test_who_is_not_there_has_not_changed_sides():
    frames = walkers(0.1, 3)
    whole = counted(count_sides(frames, *SPLITS, [1, 5]))
    absent = np.random.default_rng(1).random(frames.x_m.shape) < 0.3
    x, z = (np.where(absent, np.nan, part) for part in (frames.x_m, frames.z_m))
    some = counted(count_sides(replace(frames, x_m=x, z_m=z), *SPLITS, [1, 5]))
    np.testing.assert_allclose(some, whole, atol=0.01)


def test_a_memory_of_the_direction_is_seen_by_the_static_chain_and_not_by_the_dynamic_one():
    # after five frames, one lap, most are back
    frames, lap = walkers(0.1, 3), ("remaining_propagated", "left", 0.125)
    static, dynamic = (rows_of(frames, name) for name in ("static", "dynamic"))
    seen = counted(count_sides(frames, *SPLITS, [5]))[0, 0]
    assert dynamic[lap]["value"] == pytest.approx(seen, abs=0.01)
    assert static[lap]["ci_high"] < seen - 0.1
    error = ("chapman_kolmogorov_rms", "left", 0.125)
    # one step is what was counted: of two times only the second errs
    assert static[error]["value"] == pytest.approx((seen - static[lap]["value"]) / 2**0.5)
    assert static[error]["ci_low"] > 0.1 > 0.01 > dynamic[error]["value"]
    assert rows_of(walkers(0.5, 4), "static")[error]["value"] < 0.01


def test_timescales_are_those_of_the_ring():
    # eigenvalues cos(2 pi k / 5): the slowest two are cos(4 pi / 5), twice
    rows = rows_of(walkers(0.5, 5), "static")
    scales = [row["value"] for (quantity, *_), row in rows.items() if quantity == "implied_timescale"]
    expected = -0.025 / np.log(np.abs(np.cos(np.array([2, 2, 1, 1]) * 2 * np.pi / 5)))
    assert scales == pytest.approx(expected, rel=0.03)


def test_a_window_too_short_has_no_bands():
    rows = rows_of(walkers(0.5, 5), "static", 40.0)
    assert all(np.isnan(row["ci_low"]) for row in rows.values())


def test_an_empty_group_has_no_band_and_takes_none_from_the_others():
    # all particles lie on the line and count as up
    rows = rows_of(walkers(0.5, 8), "static")
    bands = {
        part: rows["chapman_kolmogorov_rms", part, 0.125]["ci_high"] for part in ("left", "low", "right")
    }
    assert np.isnan(bands["low"]) and bands["left"] > 0 and bands["right"] > 0


def test_counted_shares_have_the_band_of_their_blocks():
    frames = walkers(0.5, 6)
    sides = count_sides(frames, *SPLITS, [1, 2])
    rows = counted_rows(sides, frames, 1.0)
    assert [(row["time_s"], row["part"]) for row in rows][:2] == [(0.025, "left"), (0.025, "right")]
    left = rows[0]
    # of the two cells on the left, each sends half over the edge
    assert (
        left["value"] == pytest.approx(0.5, abs=0.01) and left["ci_low"] <= left["value"] <= left["ci_high"]
    )


def test_a_model_without_a_matrix_is_refused():
    frames, grid = stirred(1)
    with pytest.raises(DataError, match="jump model has no transition matrix: take it out of chain.models"):
        markovian(registry.learn("jump", frames, grid))
