# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from bedchain.chains import registry
from bedchain.errors import DataError
from bedchain.measures.batch import total_variation
from bedchain.measures.mixing import sides
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.synthetic import on_grid
from made.frames import half_remaining, kept_velocity, squared_displacement, stirred

WIDTH, MEMORY, SPEED = 0.1, 0.15, 0.1
INTERVAL = 0.025
# Mean-square displacement of the persistent walk (rho = 0.8) after 50 steps, in steps squared.
PERSISTENT_MSD = 410.00057
SIGMAS = 4.0


def places(chain, start, steps, seed=1):
    """Positions of all particles at all steps, (steps + 1, 2, n_particles)."""
    return np.array([np.array(pair) for pair in chain.walk(start, steps, np.random.default_rng(seed))])


def test_displacements_are_those_seen_in_the_cell():
    frames, grid = stirred(1, n_frames=15, n_particles=60)
    chain = registry.learn("jump", frames, grid, lag=2)
    before, after = places(chain, frames.part(slice(4, 5)), 1)
    size = np.array([[0.05], [0.08]])
    for p, cell in enumerate(frames.cells[4]):
        seen = [
            (frames.x_m[f + 2, q] - frames.x_m[f, q], frames.z_m[f + 2, q] - frames.z_m[f, q])
            for f in range(13) for q in range(60) if frames.cells[f, q] == cell
        ]  # fmt: skip
        there = np.abs(before[:, [p]] + np.array(seen).T)
        there = np.where(there > size, 2 * size - there, there)
        assert np.abs(there - after[:, [p]]).sum(axis=0).min() < 1e-8


def test_the_persistent_walk_is_recovered_with_classes_and_not_without():
    rng, n, step = np.random.default_rng(3), 40_000, 0.01
    direction = rng.choice([-1.0, 1.0], n)
    x, frames, shown = np.full(n, 5.0) + rng.uniform(-4, 4, n), [], []
    for _ in range(3):
        frames.append(x)
        shown.append(direction)
        direction = np.where(rng.random(n) < 0.1, -direction, direction)
        x = x + step * direction
    x, vx = np.array(frames), np.array(shown) * step / INTERVAL
    grid, still = Grid(10.0, 1.0, 5, 1), np.zeros(x.shape)
    seen = Frames(np.arange(3) * INTERVAL, x, still, grid.cell_of(x, still), vx, still)
    start = Frames(seen.times_s[:1], x[:1] * 0 + 5, still[:1], seen.cells[:1] * 0 + 2, vx[:1], still[:1])
    # two velocities fill two of three classes
    for classes, expected in (((3, 1), PERSISTENT_MSD), ((1, 1), 50.0)):
        chain = registry.learn("jump", seen, grid, classes=classes)
        path = places(chain, start, 50)
        squares = ((path[-1, 0] - path[0, 0]) / step) ** 2
        error = np.std(squares) / np.sqrt(n)
        # the shares of turns are those of 80 000 moves: a percent and a half of the mean square
        assert squares.mean() == pytest.approx(expected, abs=SIGMAS * error + 0.03 * expected)


@pytest.mark.parametrize("classes", [(1, 1), (7, 7)])
def test_a_bed_of_known_correlation_time_mixes_as_the_model_assumes(classes):
    grid, steps = Grid(WIDTH, WIDTH, 10, 10), 40
    frames = on_grid(kept_velocity(20_000, 81, WIDTH, MEMORY, SPEED, seed=3), grid)
    chain = registry.learn("jump", frames, grid, classes=classes)
    curves = chain.mixing(frames.part(slice(20, 22)), WIDTH / 2, WIDTH / 2, steps)
    t = np.arange(steps + 1) * INTERVAL
    # without classes every step is drawn anew: the squares of single steps add up
    once = squared_displacement(np.array(INTERVAL), MEMORY, SPEED)
    squares = once * np.arange(steps + 1) if classes == (1, 1) else squared_displacement(t, MEMORY, SPEED)
    assert np.sqrt(((curves - half_remaining(squares, WIDTH)[:, None]) ** 2).mean()) < 0.02


def test_the_long_run_density_is_that_of_the_bed():
    rng, grid = np.random.default_rng(5), Grid(0.2, 0.2, 20, 20)
    # pulled to the middle and kicked about: normal, with a variance of noise^2 / (1 - keep^2)
    keep, noise = 0.95, 0.008
    spread = noise / np.sqrt(1 - keep**2)
    away = rng.normal(0, spread, (2, 4000))
    frames = np.empty((2, 300, 4000))
    for frame in range(300):
        frames[:, frame] = np.clip(0.1 + away, 0, 0.2)
        away = keep * away + rng.normal(0, noise, away.shape)
    seen = Frames(np.arange(300) * INTERVAL, *frames, grid.cell_of(*frames))
    density = registry.learn("jump", seen, grid).long_run_density(seen).reshape(20, 20)
    bed = np.bincount(seen.cells.ravel(), minlength=400).reshape(20, 20)
    for axis in (0, 1):
        assert total_variation(density.sum(axis=axis), bed.sum(axis=axis)) < 0.015
    assert total_variation(density.ravel(), bed.ravel()) < 0.03


def test_a_wall_layer_loses_particles_by_no_more_than_is_said():
    # Kicks of half a cell: those seen to come off the wall are drawn anywhere in its cell.
    rng, grid = np.random.default_rng(6), Grid(0.1, 0.1, 10, 10)
    x, z = rng.uniform(0, 0.1, (2, 4000))
    frames = []
    for _ in range(100):
        frames.append((x, z))
        x, z = (0.1 - np.abs(0.1 - np.abs(p + rng.normal(0, 0.005, 4000))) for p in (x, z))
    x, z = np.moveaxis(np.array(frames), 1, 0)
    seen = Frames(np.arange(100) * INTERVAL, x, z, grid.cell_of(x, z))
    by_row = registry.learn("jump", seen, grid).long_run_density(seen).reshape(10, 10).sum(axis=1)
    assert by_row[1:-1] == pytest.approx(np.full(8, by_row[1:-1].mean()), rel=0.05)
    assert 0.7 < by_row[0] / by_row[1:-1].mean() < 0.95


def test_monte_carlo_counts_agree_with_the_expected_ones():
    frames, grid = stirred(2, n_particles=20_000)
    chain, start = registry.learn("jump", frames, grid, classes=(2, 2)), frames.part(slice(20, 22))
    marked = sides(start.x_m[-1], start.z_m[-1], 0.025, 0.045)
    mean, drawn = (chain.densities(start, marked, [10], rng)[0] for rng in (None, np.random.default_rng(2)))
    share = mean / marked.sum(axis=1, keepdims=True)
    # the mean is one of three runs: its own error counts a third
    error = np.sqrt(4 / 3 * marked.sum(axis=1, keepdims=True) * share * (1 - share))
    assert (np.abs(drawn - mean) < SIGMAS * error + 1).all()


def test_walls_reflect_and_empty_cells_draw_from_the_nearest():
    # all that was ever seen: particles in the bottom left cell that move 3 cm right and 1 cm up
    grid, times = Grid(0.1, 0.05, 10, 5), np.arange(2) * INTERVAL
    x, z = np.full((2, 40), 0.005), np.full((2, 40), 0.005)
    x[1], z[1] = 0.035, 0.015
    chain = registry.learn("jump", Frames(times, x, z, grid.cell_of(x, z)), grid)
    assert chain.report["empty_cells_1"] == 49
    path = places(chain, Frames(times[:1], x[:1], z[:1], grid.cell_of(x[:1], z[:1])), 6)[:, :, 0]
    assert path[:, 0] == pytest.approx([0.005, 0.035, 0.065, 0.095, 0.075, 0.095, 0.075])
    assert path[:, 1] == pytest.approx([0.005, 0.015, 0.025, 0.035, 0.045, 0.045, 0.045])


def test_classes_seen_too_seldom_draw_from_their_whole_cell():
    frames, grid = stirred(4, n_frames=12, n_particles=150)
    chain = registry.learn("jump", frames, grid, classes=(2, 3), fewest_samples=5)
    begin, count = chain._draw_from
    own = np.diff(chain.first)
    whole = own.reshape(40, 6).sum(axis=1).repeat(6)
    thin = (own < 5) & (whole > 0)
    assert (count[thin] == whole[thin]).all() and (begin[thin] == chain.first[:-1:6].repeat(6)[thin]).all()
    assert (count[own >= 5] == own[own >= 5]).all()
    assert chain.report["fallback_share_1"] == pytest.approx(own[thin].sum() / own.sum())
    assert count.min() > 0


def test_weighted_steps_are_drawn_as_often_as_they_weigh():
    frames, grid = stirred(6, n_frames=12)
    weights = np.array([0, 3, 1, 0, 0, 2, 1, 0, 0, 0, 1])
    chain = registry.learn("jump", frames, grid, step_weights=weights)
    counted = np.bincount(np.repeat(frames.cells[:11], weights, axis=0).ravel(), minlength=40)
    assert (np.diff(chain.first) == counted).all()
    dx, step = chain.samples[0], np.diff(frames.x_m, axis=0)
    assert np.sort(dx) == pytest.approx(np.sort(np.repeat(step, weights, axis=0).ravel()), abs=1e-9)


def test_expected_curves_are_the_same_each_time_and_particles_stay_inside():
    frames, grid = stirred(7)
    chain, start = registry.learn("jump", frames, grid), frames.part(slice(20, 22))
    curves = [chain.mixing(start, 0.025, 0.045, 20) for _ in range(2)]
    assert (curves[0] == curves[1]).all()
    path = places(chain, start, 200)
    assert path.min() >= 0 and (path.max(axis=(0, 2)) <= [0.05, 0.08]).all()
    with pytest.raises(DataError, match="leaves one side empty"):
        chain.mixing(start, 0.06, 0.045, 3)
