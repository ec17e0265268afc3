# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from bedchain.chains import registry, velocity_binning
from bedchain.chains.chain import Chain
from bedchain.chains.counting import count_moves
from bedchain.chains.estimators import ESTIMATORS
from bedchain.chains.velocity_class import from_counts
from bedchain.errors import DataError
from bedchain.measures.mixing import sides
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.synthetic import on_grid
from made.frames import framed, half_remaining, kept_velocity, squared_displacement, stirred

ROUND_OFF = 1e-12
# Mean-square displacement of the persistent walk (rho = 0.8) after 50 steps, in cells squared.
PERSISTENT_MSD = 410.00057
WIDTH, MEMORY, SPEED = 0.1, 0.15, 0.1
# standard errors of the share of half the particles
SIGMAS = 4.0


def with_velocities(cells: np.ndarray, direction: np.ndarray, grid: Grid) -> Frames:
    still, frames = np.zeros(cells.shape), framed(cells, grid)
    return Frames(frames.times_s, frames.x_m, frames.z_m, frames.cells, direction * 0.4, still)


def mean_square(chain: Chain, start: Frames, middle: int, steps: int) -> float:
    marked = np.ones((1, start.cells.shape[1]), bool)
    density = chain.densities(start, marked, [steps])[0, 0]
    return float(density @ (np.arange(density.size) - middle) ** 2 / density.sum())


def persistent_steps() -> tuple[np.ndarray, np.ndarray]:
    """Cells and directions in two frames: from each cell each way, nine go on and one turns back."""
    rows = [(i, d, t) for i in range(2, 119) for d in (-1, 1) for t in [1] * 9 + [-1]]
    i, d, t = np.array(rows, np.int32).T
    return np.stack((i, i + d * t)), np.stack((d, d * t))


def test_the_persistent_walk_is_recovered_exactly():
    grid = Grid(1.21, 0.01, 121, 1)
    frames = with_velocities(*persistent_steps(), grid)
    start = with_velocities(np.array([[60, 60]]), np.array([[-1, 1]]), grid)
    # two velocities fill two of three classes
    chain = registry.learn("velocity_class", frames, grid, classes=(3, 1))
    assert chain.report["states_1"] == 2 * 117 and chain.report["fallback_share_1"] == 0
    assert mean_square(chain, start, 60, 50) == pytest.approx(PERSISTENT_MSD, abs=1e-5)


@pytest.mark.parametrize("known_velocities", [True, False])
def test_a_bed_of_known_correlation_time_mixes_as_it_should(known_velocities):
    grid, steps = Grid(WIDTH, WIDTH, 20, 20), 40
    frames = on_grid(kept_velocity(20_000, 81, WIDTH, MEMORY, SPEED, seed=3), grid)
    if not known_velocities:
        frames = Frames(frames.times_s, frames.x_m, frames.z_m, frames.cells)
    known = half_remaining(squared_displacement(np.arange(steps + 1) * 0.025, MEMORY, SPEED), WIDTH)
    error = {}
    for name, options in (("static", {}), ("velocity_class", {"classes": (5, 5)})):
        chain = registry.learn(name, frames, grid, **options)
        curves = chain.mixing(frames.part(slice(20, 22)), WIDTH / 2, WIDTH / 2, steps)
        error[name] = np.sqrt(((curves - known[:, None]) ** 2).mean())
    assert chain.report["velocities_from_differences_1"] == (not known_velocities)
    # what is left is the blur of cells of 5 mm, and of differences that lag behind by half a frame
    assert error["velocity_class"] < (0.025 if known_velocities else 0.04)
    assert error["static"] > 0.1


def test_a_single_frame_without_velocities_is_no_start():
    frames, grid = stirred(9)
    chain = registry.learn("velocity_class", frames, grid)
    with pytest.raises(DataError, match="a single frame without velocities"):
        chain.mixing(frames.part(slice(1, 2)), 0.02, 0.05, 3)


def test_an_earlier_velocity_tells_when_particles_turn_back():
    # two steps right, two steps left, and so on: what comes next is known from this velocity and the last
    grid, turns = Grid(0.6, 0.01, 60, 1), np.array([1, 1, -1, -1])
    phase = np.arange(12) + np.repeat(np.arange(4), 20)[:, None]
    direction = turns[phase % 4].T
    moves = np.vstack((np.zeros((1, 80), int), direction[1:]))
    cells = np.tile(np.arange(20, 40), 4) + np.cumsum(moves, axis=0)
    frames = with_velocities(cells.astype(np.int32), direction, grid)
    start = frames.part(slice(4, 6))
    marked = np.eye(80, dtype=bool)[[10]]
    middle = int(start.cells[-1, 10])
    spread = {}
    for earlier in (0.0, 0.025):
        options = {"classes": (3, 1), "fewest_samples": 0, "earlier_s": earlier}
        chain = registry.learn("velocity_class", frames, grid, **options)
        density = chain.densities(start, marked, [8])[0, 0]
        spread[earlier] = density @ (np.arange(60) - middle) ** 2
    assert spread[0.025] == pytest.approx(0, abs=1e-12) and spread[0.0] > 4
    with pytest.raises(DataError, match="starts from 2 frames, 1 given"):
        chain.mixing(start.part(slice(1, 2)), 0.3, 0.005, 2)
    with pytest.raises(DataError, match="hold no step of 1 frames after 11"):
        registry.learn("velocity_class", frames, grid, earlier_s=0.275)


def test_one_class_is_the_static_chain():
    frames, grid = stirred(3)
    start = frames.part(slice(30, 31))
    for estimator in ESTIMATORS:
        one = registry.learn("velocity_class", stilled(frames), grid, 2, estimator, classes=(1, 1))
        static = registry.learn("static", frames, grid, 2, estimator)
        curves = [chain.mixing(stilled(start), 0.02, 0.05, 30) for chain in (one, static)]
        assert np.allclose(*curves, rtol=0, atol=ROUND_OFF)


def stilled(frames: Frames) -> Frames:
    """The frames with velocities of nothing."""
    none = np.zeros(frames.x_m.shape)
    return Frames(frames.times_s, frames.x_m, frames.z_m, frames.cells, none, none)


def test_rows_agree_with_a_plain_loop_and_thin_states_with_their_cell():
    frames, grid = stirred(4, n_frames=12, n_particles=150)
    chain = registry.learn("velocity_class", frames, grid, 2, classes=(2, 3), fewest_samples=5)
    shown = chain.symbols(frames)
    visits = np.bincount(shown[:10].ravel(), minlength=240)
    kept = np.flatnonzero(visits >= 5).tolist()
    number = {
        symbol: kept.index(symbol) if symbol in kept else len(kept) + symbol // 6 for symbol in range(240)
    }
    dense = np.zeros((len(kept) + 40,) * 2)
    for frame in range(10):
        for before, after in zip(shown[frame], shown[frame + 2], strict=True):
            if before in kept:
                dense[number[before], number[after]] += 1
            dense[len(kept) + before // 6, number[after]] += 1
    rows = chain.matrix.toarray()
    assert chain.report["states_returned_1"] == 0 and rows.shape == dense.shape
    for state, counts in enumerate(dense):
        expected = counts / counts.sum() if counts.sum() else np.eye(len(dense))[state]
        assert rows[state] == pytest.approx(expected, abs=ROUND_OFF)
    assert chain.states(frames.part(slice(0, 2))).tolist() == [number[symbol] for symbol in shown[1]]
    thin = (visits > 0) & (visits < 5)
    assert chain.report["thin_state_share_1"] == pytest.approx(thin.sum() / (visits > 0).sum())
    assert chain.report["fallback_share_1"] == pytest.approx(visits[thin].sum() / visits.sum())
    assert 0.01 < chain.report["fallback_share_1"] < 0.5


def test_without_a_fallback_the_mean_density_stays():
    frames, grid = stirred(5)
    chain = registry.learn("velocity_class", frames, grid, fewest_samples=0)
    first, last = (
        np.bincount(frames.cells[part].ravel(), minlength=40) for part in (slice(0, -1), slice(1, None))
    )
    states = chain.states_of(chain.symbols(frames)[:-1].reshape(1, -1))
    held = np.bincount(states, minlength=chain.matrix.shape[0])
    assert np.bincount(chain.cell_of_state, held, 40) == pytest.approx(first)
    assert np.bincount(chain.cell_of_state, chain.matrix.T @ held, 40) == pytest.approx(last, abs=1e-8)


def test_rows_keep_all_particles_and_monte_carlo_agrees():
    frames, grid = stirred(6, n_particles=20_000)
    chain = registry.learn("velocity_class", frames, grid)
    assert np.abs(chain.matrix.sum(axis=1) - 1).max() < ROUND_OFF
    start = frames.part(slice(20, 22))
    marked = sides(start.x_m[-1], start.z_m[-1], 0.025, 0.045)
    exact, drawn = (chain.densities(start, marked, [10], rng)[0] for rng in (None, np.random.default_rng(2)))
    share = exact / marked.sum(axis=1, keepdims=True)
    error = np.sqrt(marked.sum(axis=1, keepdims=True) * share * (1 - share))
    assert (np.abs(drawn - exact) < SIGMAS * error + 1).all()


@pytest.mark.parametrize(
    ("options", "said"), [({"classes": (3,)}, "give two numbers"), ({"classes": (0, 3)}, "each at least 1")]
)
def test_impossible_classes_are_refused(options, said):
    frames, grid = stirred(7)
    with pytest.raises(DataError, match=said):
        registry.learn("velocity_class", frames, grid, **options)


def test_counts_of_other_states_are_refused():
    frames, grid = stirred(8)
    classes = velocity_binning.quantile_classes(frames, (3, 3))
    with pytest.raises(DataError, match="counts of 40 states, 360"):
        from_counts(count_moves(frames.cells, 40), classes, grid, 0.025)
