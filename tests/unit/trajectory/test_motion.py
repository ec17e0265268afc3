# SPDX-License-Identifier: GPL-3.0-or-later
"""The check by physics: a sound series passes; a wrong time, a jump, a repeated or missing frame is named."""

import numpy as np
import pytest

from bedchain.trajectory.frame_files import Entry
from bedchain.trajectory.motion import MotionCheck

INTERVAL_S = 0.01
IDS = np.arange(400)


def series(n_frames: int = 12, seed: int = 3) -> np.ndarray:
    """Frames of particles that turn slowly: (n_frames, 4, n_particles)."""
    rng = np.random.default_rng(seed)
    phase, speed = rng.random((2, IDS.size)) * [[2 * np.pi], [0.1]]
    times = np.arange(n_frames)[:, None] * INTERVAL_S
    angle = phase + 20 * times
    x, z = speed / 20 * np.sin(angle), -speed / 20 * np.cos(angle)
    return np.stack((x, z, speed * np.cos(angle), speed * np.sin(angle)), axis=1)


def warnings(
    frames: np.ndarray, interval_s: float = INTERVAL_S, periods_m: tuple[float, float] = (0.0, 0.0)
) -> list[str]:
    check = MotionCheck(periods_m)
    for at, rows in enumerate(frames):
        check.add(Entry("run.dump", at, 100 * at, at * interval_s, IDS.size), IDS, rows)
    assert len(check.table()) == len(frames) - 1
    return check.warnings()


def test_a_sound_series_has_no_warnings():
    assert warnings(series()) == []


def test_who_crosses_a_periodic_side_has_moved_the_short_way():
    frames = series()
    frames[:, 0] %= 0.004
    assert warnings(frames, periods_m=(0.004, 0.0)) == [] != warnings(frames)


@pytest.mark.parametrize("factor", [10, 0.1, 4])
def test_a_wrong_time_is_told_with_its_factor(factor):
    (message,) = warnings(series(), INTERVAL_S * factor)
    slope = float(message.split()[2])
    assert slope * factor == pytest.approx(1, abs=0.02) and "frames.step_s" in message


def test_a_missing_frame_is_named_with_its_factor():
    (message,) = warnings(np.delete(series(), 6, axis=0))
    assert "from run.dump (step 500) to run.dump (step 600) particles move" in message and " 2.0" in message


def test_a_repeated_frame_is_named():
    messages = warnings(np.insert(series(), 6, series()[5], axis=0))
    assert messages == [
        "run.dump (step 600) repeats the positions of run.dump (step 500): no particle has moved between them"
    ]


def test_two_runs_that_are_mixed_are_told_at_their_seam():
    other = series(seed=4)
    (message,) = warnings(np.concatenate((series(), other)))
    assert "from run.dump (step 1100) to run.dump (step 1200)" in message and "two runs are mixed" in message


def test_frames_too_far_apart_or_without_velocities_are_not_judged():
    frames = series()
    frames[:, 2:] = np.random.default_rng(5).normal(0, 0.1, frames[:, 2:].shape)
    (message,) = warnings(frames)
    assert "too far apart" in message
    still = series()
    still[:, 2:] = np.nan
    assert warnings(still) == []


def test_particles_that_come_and_go_are_left_aside():
    check, frames = MotionCheck(), series()
    for at, rows in enumerate(frames):
        there = IDS[at != IDS % 12]
        check.add(Entry("run.dump", at, at, at * INTERVAL_S, there.size), there, rows[:, there])
    assert check.warnings() == [] and check.intervals[0].slope == pytest.approx(1, abs=0.01)
