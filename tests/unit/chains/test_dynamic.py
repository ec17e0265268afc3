# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from bedchain.chains import dynamic, registry
from bedchain.chains.chain import Chain
from bedchain.chains.counting import count_moves
from bedchain.chains.estimators import ESTIMATORS
from bedchain.errors import DataError
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid
from made.frames import framed, stirred

ROUND_OFF = 1e-12
# Mean-square displacement of the persistent walk (rho = 0.8) after 50 steps, in cells squared.
PERSISTENT_MSD = 410.00057


def persistent_walk(n_cells: int, n_particles: int, n_frames: int, rng: np.random.Generator) -> np.ndarray:
    place = rng.integers(0, n_cells, n_particles)
    direction = rng.choice([-1, 1], n_particles)
    cells = np.empty((n_frames, n_particles), np.int32)
    for frame in range(n_frames):
        cells[frame] = place
        turned = (rng.random(n_particles) < 0.1) | (place + direction < 0) | (place + direction >= n_cells)
        direction = np.where(turned, -direction, direction)
        place = np.clip(place + direction, 0, n_cells - 1)
    return cells


def mean_square(chain: Chain, start: Frames, middle: int, steps: int) -> float:
    marked = np.ones((1, start.cells.shape[1]), bool)
    density = chain.densities(start, marked, [steps])[0, 0]
    return float(density @ (np.arange(density.size) - middle) ** 2 / density.sum())


def test_the_dynamic_chain_recovers_the_persistent_walk_exactly():
    # Every pair of neighbours, seen ten times: nine go on, one turns back.
    paths = [[i, i + d, i + 2 * d] for i in range(2, 119) for d in (-1, 1) for _ in range(9)]
    paths += [[i, i + d, i] for i in range(2, 119) for d in (-1, 1)]
    cells = np.array(paths, np.int32).T
    grid = Grid(1.21, 0.01, 121, 1)
    start = framed(np.array([[59, 61], [60, 60]]), grid)
    chain = registry.learn("dynamic", framed(cells, grid), grid)
    assert mean_square(chain, start, 60, 50) == pytest.approx(PERSISTENT_MSD, abs=1e-5)
    first_order = registry.learn("static", framed(cells, grid), grid)
    assert mean_square(first_order, start, 60, 50) == pytest.approx(50, abs=1e-9)


def test_the_dynamic_chain_recovers_the_persistent_walk_from_frames():
    rng = np.random.default_rng(12)
    grid = Grid(2.01, 0.01, 201, 1)
    frames = framed(persistent_walk(201, 20_000, 100, rng), grid)
    start = framed(np.array([[99, 101], [100, 100]]), grid)
    expected = {"dynamic": (PERSISTENT_MSD, 0.03), "static": (50.0, 0.03)}
    for name, (displacement, tolerance) in expected.items():
        mean_square_displacement = mean_square(registry.learn(name, frames, grid), start, 100, 50)
        assert mean_square_displacement == pytest.approx(displacement, rel=tolerance), name


@pytest.mark.parametrize("estimator", list(ESTIMATORS))
def test_a_constant_process_gives_static_equal_to_dynamic(estimator):
    grid = Grid(0.04, 0.03, 4, 3)
    rng = np.random.default_rng(1)
    still = np.tile(rng.integers(0, 12, 50), (20, 1))
    shift = (rng.integers(0, 12, 50) + np.arange(21)[:, None] * 5) % 12
    for cells in (still, shift):
        frames = framed(cells, grid)
        if estimator == "literal":
            # All cells hold particles all the time, or they leak at different rates.
            frames = framed(
                np.concatenate([cells, (np.arange(12) + cells[:, :1] - cells[0, 0]) % 12], axis=1), grid
            )
        start = frames.part(slice(0, 2))
        curves = [
            registry.learn(name, frames, grid, 1, estimator).mixing(start, 0.02, 0.01, 15)
            for name in ("static", "dynamic", "velocity_class")
        ]
        assert np.allclose(curves[0], curves[1], rtol=0, atol=ROUND_OFF, equal_nan=True)


def test_pairs_seen_once_follow_what_they_did():
    grid = Grid(0.03, 0.01, 3, 1)
    cells = np.array([[0, 1, 2, 1, 0, 1, 2, 1, 0]]).T
    chain = registry.learn("dynamic", framed(cells, grid), grid)
    assert [int(c[0]) for c in chain.paths(framed(cells[:2], grid), 6, np.random.default_rng(1))] == [
        1,
        2,
        1,
        0,
        1,
        2,
        1,
    ]


def test_an_unknown_pair_falls_back_on_the_static_row():
    grid = Grid(0.04, 0.01, 4, 1)
    cells = np.array([[0, 1, 2, 1, 0, 1, 2, 1, 0], [2, 1, 0, 1, 2, 1, 0, 1, 2]]).T
    learned = framed(cells, grid)
    static, chain = (registry.learn(name, learned, grid) for name in ("static", "dynamic"))
    marked = np.ones((1, 1), bool)
    for before in (1, 3):  # never (1, 1) nor (3, 1)
        start = framed(np.array([[before], [1]]), grid)
        one = [model.densities(start, marked, [1])[0, 0].tolist() for model in (static, chain)]
        assert one[0] == one[1] == [0.5, 0, 0.5, 0]
    never = framed(np.array([[3], [3]]), grid)
    assert chain.densities(never, marked, [9])[0, 0].tolist() == [0, 0, 0, 1.0]


def test_dynamic_matrix_agrees_with_a_loop_over_pairs():
    frames, grid = stirred(3)
    chain = registry.learn("dynamic", frames, grid)
    start = frames.part(slice(10, 12))
    path = frames.cells
    expected = np.zeros(grid.n_cells)
    for p in range(path.shape[1]):
        same = (path[:-2] == path[10, p]) & (path[1:-1] == path[11, p])
        expected += np.bincount(path[2:][same], minlength=grid.n_cells) / same.sum()
    densities = chain.densities(start, np.ones((1, path.shape[1]), bool), [1])[0, 0]
    assert np.allclose(densities, expected, atol=1e-9)


def test_a_pair_entered_only_at_the_end_moves_on_as_its_cell_does():
    grid = Grid(0.03, 0.01, 3, 1)
    to_and_fro = [[0, 1] * 4] * 6
    cells = np.array([*to_and_fro, [0, 1, 0, 1, 0, 2, 2, 2]]).T
    chain = registry.learn("dynamic", framed(cells, grid), grid)
    assert chain.report["pairs_opened_1"] == 1
    density = chain.long_run_density(framed(cells[:2], grid))
    assert density[2] < 0.2 and density.sum() == pytest.approx(1)


def test_counts_of_single_cells_are_no_pairs():
    frames, grid = stirred(13)
    single = count_moves(frames.cells, grid.n_cells)
    with pytest.raises(DataError, match="count_pairs makes them"):
        dynamic.from_counts(single, single, grid, 0.025)


def test_every_step_counted_twice_makes_the_same_dynamic_chain():
    frames, grid = stirred(9)
    n_steps = len(frames.times_s) - 1
    whole = registry.learn("dynamic", frames, grid)
    twice = registry.learn("dynamic", frames, grid, step_weights=np.full(n_steps, 2))
    parts = [
        registry.learn("dynamic", frames, grid, step_weights=part.astype(int))
        for part in (np.arange(n_steps) < 30, np.arange(n_steps) >= 30)
    ]
    for key, array in whole.arrays().items():
        assert key == "report" or (array == twice.arrays()[key]).all(), key
    assert (np.union1d(*(part.state_keys for part in parts)) == whole.state_keys).all()
