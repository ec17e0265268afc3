# SPDX-License-Identifier: GPL-3.0-or-later
"""Packed positions come back exactly, lie on their side of every line, and files cut off are refused."""

import numpy as np
import pytest

from bedchain.errors import UserError
from bedchain.trajectory.packed_positions import (
    levels_of,
    middle_of,
    read_levels,
    with_velocities,
    write_levels,
)

LEVEL = 1e-3
INTERVAL = 0.025


def drawn_levels(n_frames, number, seed=1):
    """Levels with everything that wraps around: walks of large steps, and both ends of the range."""
    rng = np.random.default_rng(seed)
    steps = rng.integers(-20000, 20000, (n_frames, 2, number))
    levels = np.cumsum(steps, axis=0).astype(np.uint16)
    levels[0], levels[1], levels[2] = 0, 65535, 0
    return levels


@pytest.mark.parametrize("n_frames", [3, 4, 17])
def test_levels_come_back_bit_by_bit(tmp_path, n_frames):
    levels = drawn_levels(n_frames, 50)
    write_levels(iter(levels), tmp_path / "p.xz")
    np.testing.assert_array_equal(list(read_levels(tmp_path / "p.xz", n_frames, 50)), levels)


def test_smooth_motion_takes_about_a_byte(tmp_path):
    rng = np.random.default_rng(2)
    speed = 5 + np.cumsum(rng.normal(0, 1, (100, 2, 500)), axis=0)
    levels = np.floor(30000 + np.cumsum(speed, axis=0)).astype(np.uint16)
    write_levels(iter(levels), tmp_path / "p.xz")
    # the entropy of a normal deviate of sigma 1.2 in whole levels is 2.3 bits for each coordinate
    assert (tmp_path / "p.xz").stat().st_size / (100 * 500) < 0.8


def test_a_file_that_is_cut_off_or_goes_on_is_refused(tmp_path):
    levels = drawn_levels(6, 400)
    whole = tmp_path / "p.xz"
    write_levels(iter(levels), whole)
    with pytest.raises(UserError, match="ends at frame 6 of 7"):
        list(read_levels(whole, 7, 400))
    with pytest.raises(UserError, match="more than 5 frames"):
        list(read_levels(whole, 5, 400))
    whole.write_bytes(whole.read_bytes()[: whole.stat().st_size // 2])
    with pytest.raises(UserError, match=r"ends at frame \d of 6"):
        list(read_levels(whole, 6, 400))


def test_a_file_without_its_last_bytes_is_refused(tmp_path):
    """All frames are there, but not the checksum that says that they are right."""
    whole = tmp_path / "p.xz"
    write_levels(iter(drawn_levels(6, 400)), whole)
    whole.write_bytes(whole.read_bytes()[:-4])
    with pytest.raises(UserError, match="damaged behind its last frame"):
        list(read_levels(whole, 6, 400))


def test_a_number_of_particles_that_no_memory_holds_is_refused(tmp_path):
    whole = tmp_path / "p.xz"
    write_levels(iter(drawn_levels(6, 400)), whole)
    with pytest.raises(UserError, match="ends at frame 0 of 6"):
        next(read_levels(whole, 6, 10**15))


def test_a_missing_file_is_a_sentence(tmp_path):
    with pytest.raises(UserError, match="cannot be read"):
        next(read_levels(tmp_path / "p.xz", 6, 400))


def test_rounded_positions_stay_in_their_cell_and_on_their_side():
    lines = np.arange(1, 270) * LEVEL
    drawn = np.random.default_rng(3).uniform(0, 0.27, 20000)
    exact = np.concatenate([drawn, lines - 1e-7, lines + 1e-7])
    rounded = middle_of(levels_of(exact, LEVEL), LEVEL).astype(float)
    assert np.abs(rounded - exact).max() <= LEVEL / 2 * (1 + 1e-3)
    for width in (0.01, 0.005, 0.009):
        np.testing.assert_array_equal(np.floor(rounded / width), np.floor(exact / width))
    np.testing.assert_array_equal(rounded < 0.135, exact < 0.135)


def test_velocities_are_central_differences():
    times = INTERVAL * np.arange(6)
    x = 0.1 + 2.0 * times - 3.0 * times**2
    levels = [np.full((2, 3), round(place / 1e-5), np.uint16) for place in x]
    frames = list(with_velocities(levels, 1e-5, INTERVAL))
    assert len(frames) == 6 and frames[0].shape == (4, 3) and frames[0].dtype == np.float32
    found = np.array([frame[2, 0] for frame in frames])
    np.testing.assert_allclose(found[1:-1], (2.0 - 6.0 * times)[1:-1], atol=1e-3)
    np.testing.assert_allclose(found[0], (x[1] - x[0]) / INTERVAL, atol=1e-3)
    np.testing.assert_allclose(found[-1], (x[-1] - x[-2]) / INTERVAL, atol=1e-3)


def test_positions_outside_the_levels_are_refused():
    with pytest.raises(UserError, match="65 536"):
        levels_of(np.array([-1e-4, 0.1]), LEVEL)
    with pytest.raises(UserError, match="take larger ones"):
        levels_of(np.array([0.1, 66.0]), LEVEL)
