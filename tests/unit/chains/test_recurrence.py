# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from bedchain.chains import registry
from bedchain.errors import DataError
from bedchain.measures.mixing import remaining_from_positions, sides
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.synthetic import on_grid
from made.frames import half_remaining, kept_velocity, squared_displacement, stirred

INTERVAL = 0.025
ORDERS = ("recurrence", "shuffled", "replay")


def places(chain, start, steps, seed=1):
    """Positions of all tracers at all steps, (steps + 1, 2, n_particles)."""
    return np.array([np.array(pair) for pair in chain.walk(start, steps, np.random.default_rng(seed))])


def swinging(n_frames: int, n_particles: int = 2000, period: int = 16, seed: int = 2) -> tuple[Frames, Grid]:
    """A heap that swings from side to side as one, with a period of so many frames."""
    rng, grid = np.random.default_rng(seed), Grid(0.2, 0.1, 20, 10)
    turn = 2 * np.pi * np.arange(n_frames)[:, None] / period
    x = rng.uniform(0.06, 0.14, n_particles) + 0.05 * np.sin(turn)
    z = np.tile(rng.uniform(0.0, 0.08, n_particles), (n_frames, 1))
    vx = 0.05 * np.cos(turn) * 2 * np.pi / (period * INTERVAL) * np.ones(n_particles)
    return Frames(np.arange(n_frames) * INTERVAL, x, z, grid.cell_of(x, z), vx, np.zeros(x.shape)), grid


def test_jumps_lead_to_the_most_alike_frames_far_enough_away():
    frames, grid = stirred(1)
    options = {"segment_s": 0.1, "separation_s": 0.25, "neighbours": 3}
    chain = registry.learn("recurrence", frames, grid, **options)
    path = chain.path(frames.part(slice(20, 22)), 2000, np.random.default_rng(3))
    between, jumps = chain.fields.distances(), 0
    assert path[0] == 21 and min(path) >= 0 and max(path) <= 58
    for now, after in zip(path, path[1:], strict=False):
        if after == now + 1:
            continue
        jumps += 1
        here = now + 1
        allowed = [frame for frame in range(59) if abs(frame - here) >= 10]
        closer = sum(between[here, frame] < between[here, after] for frame in allowed)
        assert after in allowed and closer < 3
    # one in four by chance, and at the end of the window
    assert 0.2 < jumps / 2000 < 0.35


def test_the_window_replayed_is_the_window():
    grid = Grid(0.1, 0.1, 10, 10)
    frames = on_grid(kept_velocity(400, 30, 0.1, 0.1, 0.1, seed=2), grid)
    chain = registry.learn("recurrence", frames, grid, lag=2, order="replay")
    path = places(chain, frames.part(slice(0, 1)), 14)
    for step in range(15):
        assert path[step, 0] == pytest.approx(frames.x_m[2 * step], abs=1e-6)
        assert path[step, 1] == pytest.approx(frames.z_m[2 * step], abs=1e-6)
    known = remaining_from_positions(frames.x_m[:29:2], frames.z_m[:29:2], 0.05, 0.04)
    assert chain.mixing(frames.part(slice(0, 1)), 0.05, 0.04, 14) == pytest.approx(known, abs=1e-9)
    assert chain.path(frames.part(slice(0, 1)), 20, np.random.default_rng(1))[14:17] == [0, 2, 4]


def test_a_bed_that_recurs_is_followed_beyond_its_window():
    frames, grid = swinging(161)
    start, steps = frames.part(slice(92, 97)), 64
    known = remaining_from_positions(frames.x_m[96:], frames.z_m[96:], 0.1, 0.04)
    assert known[:, 0].min() < 0.2
    options = {"segment_s": 0.1, "separation_s": 0.2, "neighbours": 1}
    chain = registry.learn("recurrence", frames.part(slice(0, 51)), grid, **options)
    assert chain.report["jump_distance_1"] < 1e-3 < chain.report["step_distance_1"]
    assert np.abs(chain.mixing(start, 0.1, 0.04, steps) - known).max() < 0.01
    path = places(chain, start, steps)
    assert np.abs(path[:, 0] - frames.x_m[96:]).max() < 1e-4
    # without similar frames the phase is lost
    other = registry.learn("recurrence", frames.part(slice(0, 51)), grid, order="shuffled")
    assert np.abs(other.mixing(start, 0.1, 0.04, steps) - known).max() > 0.2


def test_a_bed_of_known_correlation_time_mixes_as_it_should():
    width, memory, speed, steps = 0.1, 0.05, 0.2, 60
    grid = Grid(width, width, 10, 10)
    frames = on_grid(kept_velocity(4000, 121, width, memory, speed, seed=3), grid)
    t, once = np.arange(steps + 1) * INTERVAL, squared_displacement(np.array(INTERVAL), memory, speed)
    known = half_remaining(squared_displacement(t, memory, speed), width)
    no_memory = half_remaining(once * np.arange(steps + 1), width)
    for order, expected in (("recurrence", known), ("shuffled", no_memory)):
        chain = registry.learn("recurrence", frames, grid, order=order, segment_s=1.0)
        curves = chain.mixing(frames.part(slice(60, 61)), width / 2, width / 2, steps)
        assert np.sqrt(((curves - expected[:, None]) ** 2).mean()) < 0.03, order
    assert np.sqrt(((known - no_memory) ** 2).mean()) > 0.06


@pytest.mark.parametrize("order", ORDERS)
def test_expected_curves_are_the_mean_of_paths(order):
    frames, grid = stirred(3, n_particles=300)
    chain, start = registry.learn("recurrence", frames, grid, order=order), frames.part(slice(20, 22))
    expected = chain.mixing(start, 0.025, 0.045, 15)
    drawn = np.array([chain.mixing(start, 0.025, 0.045, 15, np.random.default_rng(s)) for s in range(40)])
    error = drawn.std(axis=0, ddof=1) * np.sqrt(1 / 40 + 1 / chain.expected_paths)
    assert (np.abs(drawn.mean(axis=0) - expected) < 4.5 * error + 1e-12).all()
    assert (expected == chain.mixing(start, 0.025, 0.045, 15)).all()


@pytest.mark.parametrize("order", ORDERS)
def test_particles_are_kept_and_stay_inside(order):
    frames, grid = stirred(4)
    chain, start = registry.learn("recurrence", frames, grid, order=order), frames.part(slice(20, 22))
    path = places(chain, start, 80)
    assert path.min() >= 0 and (path.max(axis=(0, 2)) <= [0.05, 0.08]).all()
    marked = sides(start.x_m[-1], start.z_m[-1], 0.025, 0.045)
    for rng in (None, np.random.default_rng(2)):
        counts = chain.densities(start, marked, [0, 40, 80], rng)
        assert counts.sum(axis=2) == pytest.approx(np.tile(marked.sum(axis=1), (3, 1)))


@pytest.mark.parametrize("order", ORDERS)
def test_steps_of_no_weight_are_never_played(order):
    frames, grid = stirred(5)
    weights = np.zeros(59, np.int64)
    weights[[3, 4, 5, 30, 31, 32, 50]] = [1, 2, 1, 1, 1, 1, 3]
    chain = registry.learn("recurrence", frames, grid, step_weights=weights, order=order)
    path = chain.path(frames.part(slice(20, 22)), 400, np.random.default_rng(3))
    assert set(path) <= set(np.flatnonzero(weights).tolist()) and len(set(path)) > 3


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"order": "backwards"}, "order 'backwards' is unknown: choose one of recurrence, shuffled, replay"),
        ({"neighbours": 0}, "must be positive"),
        ({"separation_s": 1.0}, "no other 1 s or more away"),
    ],
)
def test_impossible_settings_are_refused(options, said):
    frames, grid = stirred(6)
    with pytest.raises(DataError, match=said):
        registry.learn("recurrence", frames, grid, **options)
