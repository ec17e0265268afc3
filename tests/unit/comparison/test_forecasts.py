# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from scipy import sparse

from bedchain.chains import propagate, registry
from bedchain.chains.counting import count_moves
from bedchain.chains.estimators import transition_matrix, visited_density
from bedchain.comparison.forecasts import LISTED_KEYS, count_sides, count_starts, counted, propagated, ranked
from bedchain.errors import DataError
from bedchain.measures import mixing
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid

ROUND_OFF = 1e-12
SPLITS = (0.02, 0.01)
GRID = Grid(0.04, 0.03, 4, 3)


def walk_frames(n_particles: int, steps: int, seed: int = 1) -> Frames:
    """A chain that is Markov on the grid's cells, particles in their middles."""
    rng = np.random.default_rng(seed)
    dense = rng.random((12, 12)) ** 6 + np.eye(12)
    matrix = sparse.csr_array(dense / dense.sum(axis=1, keepdims=True))
    cells = propagate.simulate(matrix, rng.integers(0, 12, n_particles), steps, rng)
    x, z = np.moveaxis(GRID.centres_m[cells], -1, 0)
    return Frames(np.arange(len(cells)) * 0.025, x, z, cells)


def by_dense_powers(frames: Frames, multiples: list[int], lag: int, weights: np.ndarray) -> np.ndarray:
    """Share of each group on its side after k steps of the static chain, with the whole matrix to the k."""
    shares = mixing.side_shares(GRID, *SPLITS)
    counts = count_moves(frames.cells, GRID.n_cells, lag, step_weights=weights)
    start, matrix = shares * visited_density(counts), transition_matrix(counts).toarray()
    after = [start @ np.linalg.matrix_power(matrix, k) for k in multiples]
    return np.array([(density * shares).sum(axis=1) / start.sum(axis=1) for density in after])


def of_model(name: str, frames: Frames, lag: int, gaps: list[int], weights: np.ndarray) -> np.ndarray:
    sides = count_sides(frames, *SPLITS, gaps)
    chain = registry.learn(name, frames, GRID, lag, "pooled", weights)
    # each step is a block of its own
    starts = count_starts(frames, chain, sides, np.arange(len(weights) + 1))
    rows, remaining = propagated(chain, starts, sides, weights)
    assert rows.tolist() == [row for row, gap in enumerate(gaps) if gap % lag == 0]
    return remaining


def test_counted_shares_agree_with_a_plain_loop():
    frames, gaps = walk_frames(40, 9), [1, 3, 4]
    weights = np.array([2, 0, 1, 1, 3, 0, 0, 2, 1])
    shares = counted(count_sides(frames, *SPLITS, gaps), weights)
    for row, gap in enumerate(gaps):
        began, stayed = np.zeros(4), np.zeros(4)
        for first in range(10 - gap):
            for times in range(weights[first] if first < 9 else 0):
                del times
                now, later = (
                    mixing.sides(frames.x_m[f], frames.z_m[f], *SPLITS) for f in (first, first + gap)
                )
                began += now.sum(axis=1)
                stayed += (now & later).sum(axis=1)
        assert shares[row] == pytest.approx(stayed / began, abs=ROUND_OFF)


@pytest.mark.parametrize("lag", [1, 2])
def test_the_static_chain_gives_what_the_counts_alone_give(lag):
    frames, multiples = walk_frames(300, 40), [1, 2, 5]
    weights = np.random.default_rng(3).integers(0, 3, 41 - lag)
    gaps = [lag * k for k in multiples]
    expected = by_dense_powers(frames, multiples, lag, weights)
    assert of_model("static", frames, lag, gaps, weights) == pytest.approx(expected, abs=ROUND_OFF)


def test_one_step_of_the_static_chain_is_what_the_frames_show():
    frames, ones = walk_frames(300, 40), np.ones(39, int)
    seen = counted(count_sides(frames, *SPLITS, [2]), ones)
    assert of_model("static", frames, 2, [2], ones) == pytest.approx(seen, abs=ROUND_OFF)


def test_one_step_of_the_dynamic_chain_is_what_the_frames_show_after_the_first_step():
    frames, ones = walk_frames(300, 40), np.ones(40, int)
    seen = counted(count_sides(frames.part(slice(1, None)), *SPLITS, [1]))
    assert of_model("dynamic", frames, 1, [1], ones) == pytest.approx(seen, abs=ROUND_OFF)


@pytest.mark.parametrize("earlier", [0.0, 0.075])
def test_one_step_of_the_velocity_class_chain_is_what_the_frames_show(earlier):
    frames, ones = walk_frames(300, 40), np.ones(40, int)
    back = round(earlier / 0.025)
    sides = count_sides(frames, *SPLITS, [1])
    chain = registry.learn(
        "velocity_class", frames, GRID, classes=(2, 2), fewest_samples=0, earlier_s=earlier
    )
    _, remaining = propagated(
        chain, count_starts(frames, chain, sides, np.arange(len(ones) + 1)), sides, ones
    )
    seen = counted(count_sides(frames.part(slice(back, None)), *SPLITS, [1]))
    assert remaining == pytest.approx(seen, abs=ROUND_OFF)


@pytest.mark.parametrize("name", ["static", "dynamic"])
def test_weighted_starts_agree_with_a_plain_loop_over_frames(name):
    frames, lag, gaps = walk_frames(60, 20), 2, [2, 6]
    weights = np.random.default_rng(4).integers(0, 3, 19)
    chain = registry.learn(name, frames, GRID, lag, "pooled", weights)
    before, start = (chain.history - 1) * lag, np.zeros((4, chain.matrix.shape[0]))
    for frame in range(before, 19):
        states = chain.states(frames.part(slice(frame - before, frame + 1)))
        marked = mixing.sides(frames.x_m[frame], frames.z_m[frame], *SPLITS)
        start += weights[frame] * mixing.marked_histogram(states, marked, start.shape[1])
    on_side = mixing.side_shares(GRID, *SPLITS)[:, chain.cell_of_state]
    later = [start @ np.linalg.matrix_power(chain.matrix.toarray(), gap // lag) for gap in gaps]
    expected = [(now * on_side).sum(axis=1) / start.sum(axis=1) for now in later]
    assert of_model(name, frames, lag, gaps, weights) == pytest.approx(np.array(expected), abs=ROUND_OFF)


def test_a_markov_bed_is_followed_by_both_models():
    frames, gaps = walk_frames(20_000, 40), [1, 4, 10]
    seen = counted(count_sides(frames, *SPLITS, gaps))
    for name in ("static", "dynamic"):
        assert of_model(name, frames, 1, gaps, np.ones(40, int)) == pytest.approx(seen, abs=0.01)


def test_a_gap_as_long_as_the_window_is_refused():
    with pytest.raises(DataError, match="10 frames hold no two that are 10 apart"):
        count_sides(walk_frames(5, 9), *SPLITS, [2, 10])


@pytest.mark.parametrize("n_keys", [50, LISTED_KEYS + 1])
def test_keys_are_ranked_alike_from_a_list_and_by_sorting(n_keys):
    keys = np.array([[7, 49, 7], [0, 12, 49]])
    distinct, ranks = ranked(keys, n_keys)
    assert distinct.tolist() == [0, 7, 12, 49]
    assert ranks.tolist() == [[1, 3, 1], [0, 2, 3]]
