# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains between their steps: products of dense matrices, files, and walkers with known curves."""

import numpy as np
import pytest

from bedchain.chains import registry
from bedchain.chains.between_steps import (
    Fractions,
    densities_at,
    fractions_relearner,
    learn_fractions,
    mixing_by_frame,
)
from bedchain.measures.mixing import Splits, side_shares, sides
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.synthetic import on_grid
from bedchain.uncertainty.bands import kept_blocks, kept_steps
from made.frames import half_remaining, kept_velocity, squared_displacement, stirred

LAG, SPLITS = 4, Splits(0.025, 0.04)
ROUND_OFF = 1e-12
# of a curve of 750 walkers, whose start is not quite even
SCATTER = 0.01


@pytest.fixture(scope="module")
def bed():
    frames, grid = stirred()
    return (
        frames,
        grid,
        registry.learn("static", frames, grid, LAG),
        learn_fractions(frames, grid.n_cells, LAG),
    )


def test_curves_are_products_of_the_matrices(bed):
    frames, grid, chain, fractions = bed
    start = frames.part(slice(0, 1))
    curves = mixing_by_frame(chain, fractions, start, SPLITS, 10)
    marked = sides(start.x_m[-1], start.z_m[-1], *SPLITS)
    shares = side_shares(grid, *SPLITS)
    begin = np.array([np.bincount(start.cells[-1][group], minlength=grid.n_cells) for group in marked])
    assert curves.shape == (11, 4) and (curves[0] == 1).all()
    for frame in range(1, 11):
        whole, rest = divmod(frame, LAG)
        now = begin @ np.linalg.matrix_power(chain.matrix.toarray(), whole)
        now = now @ fractions.matrices[rest - 1].toarray() if rest else now
        np.testing.assert_allclose(
            curves[frame], (now * shares).sum(axis=1) / marked.sum(axis=1), atol=ROUND_OFF
        )


@pytest.mark.parametrize("model", ["static", "dynamic", "jump", "recurrence"])
def test_whole_steps_are_those_of_the_chain(bed, model):
    frames, grid, _, fractions = bed
    options = {"segment_s": 0.2, "coarse_m": 0.02, "separation_s": 0.1} if model == "recurrence" else {}
    chain = registry.learn(model, frames, grid, LAG, **options)
    start = frames.part(slice(0, 20))
    curves = mixing_by_frame(chain, fractions, start, SPLITS, 12)
    np.testing.assert_allclose(curves[::LAG], chain.mixing(start, *SPLITS, 3), atol=ROUND_OFF)
    assert ((curves > 0) & (curves <= 1)).all()
    marked = start.cells[-1][None] < 10
    at = densities_at(chain, fractions, start, marked, [0, 3, 4, 9])
    np.testing.assert_allclose(at.sum(axis=2), marked.sum(), rtol=ROUND_OFF)
    np.testing.assert_allclose(at[2], chain.densities(start, marked, [1])[0], atol=ROUND_OFF)


def test_a_monte_carlo_has_the_expectation(bed):
    frames, _, chain, fractions = bed
    start = frames.part(slice(0, 1))
    drawn = mixing_by_frame(chain, fractions, start, SPLITS, 10, np.random.default_rng(2))
    exact = mixing_by_frame(chain, fractions, start, SPLITS, 10)
    assert 0 < np.abs(drawn - exact)[1 + LAG :].max() < 4.5 * 0.5 / np.sqrt(100)


def test_a_lag_of_one_frame_has_no_fractions(bed):
    frames, grid, _, _ = bed
    chain, fractions = registry.learn("static", frames, grid), learn_fractions(frames, grid.n_cells, 1)
    start = frames.part(slice(0, 1))
    assert fractions == Fractions(())
    np.testing.assert_array_equal(
        mixing_by_frame(chain, fractions, start, SPLITS, 5), chain.mixing(start, *SPLITS, 5)
    )


def test_fractions_are_stored_beside_the_chain(bed, tmp_path):
    _, _, chain, fractions = bed
    registry.save(chain, tmp_path / "c.npz", fractions)
    again = registry.load_fractions(tmp_path / "c.npz")
    assert again.lag == LAG and registry.load(tmp_path / "c.npz").lag == LAG
    for one, other in zip(again.matrices, fractions.matrices, strict=True):
        assert (one != other).nnz == 0
    registry.save(chain, tmp_path / "without.npz")
    assert registry.load_fractions(tmp_path / "without.npz").lag == 1


def test_fractions_without_a_block_are_those_of_its_weights(bed):
    frames, grid, _, fractions = bed
    of_step = fractions_relearner(frames, grid.n_cells, LAG)
    for kept in kept_blocks():
        expected = learn_fractions(
            frames,
            grid.n_cells,
            LAG,
            weights=lambda lag, kept=kept: kept_steps(kept, len(frames.times_s) - lag),
        )
        assert of_step(kept).lag == LAG
        for one, other, whole in zip(
            of_step(kept).matrices, expected.matrices, fractions.matrices, strict=True
        ):
            np.testing.assert_allclose(one.toarray(), other.toarray(), atol=ROUND_OFF)
            assert (one != whole).nnz > 0


def test_between_steps_a_long_lag_is_as_good_as_at_its_steps():
    size, memory_s, speed, lag, length = 0.3, 0.1, 0.2, 40, 160
    frames = kept_velocity(1500, 241, size, memory_s, speed, 2)
    grid = Grid(size, size, 10, 10)
    frames, splits = on_grid(frames, grid), Splits(size / 2, size / 2)
    chain, fractions = registry.learn("static", frames, grid, lag), learn_fractions(frames, 100, lag)
    times = np.arange(length + 1) * frames.interval_s
    known = half_remaining(squared_displacement(times, memory_s, speed), size)[:, None]
    curves = mixing_by_frame(chain, fractions, frames.part(slice(0, 1)), splits, length)
    steps = np.arange(0, length + 1, lag)
    line = np.stack([np.interp(np.arange(length + 1), steps, curve) for curve in curves[steps].T], axis=1)
    at_steps, at_all = (np.sqrt(np.mean((curves - known)[each::each] ** 2)) for each in (lag, 1))
    assert at_all < 1.5 * at_steps + SCATTER
    assert at_all < 0.8 * np.sqrt(np.mean((line - known)[1:] ** 2))
