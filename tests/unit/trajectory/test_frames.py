# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.trajectory.frames import Frames, check_times, lag_frames, whole_steps, window

TIMES = np.round(np.arange(0, 401) * 0.025, 6)


def test_window_holds_both_ends():
    part = window(TIMES, 5.0, 7.5)
    assert TIMES[part][[0, -1]].tolist() == [5.0, 7.5] and len(TIMES[part]) == 101


@pytest.mark.parametrize(
    ("start", "end", "message"),
    [
        (5.0, 5.0, "empty"),
        (6.0, 5.0, "empty"),
        (5.01, 6.0, "start, 5.01 s, is not the time"),
        (9.0, 10.5, "end, 10.5 s"),
    ],
)
def test_bad_windows_are_refused(start, end, message):
    with pytest.raises(DataError, match=message):
        window(TIMES, start, end)


def test_missing_doubled_and_disordered_frames_are_named():
    with pytest.raises(DataError, match=r"missing: frame 9 is at 0\.225 s and frame 10 at 0\.275"):
        check_times(np.delete(TIMES, 10))
    with pytest.raises(DataError, match="out of order or doubled: frame 10"):
        check_times(np.insert(TIMES, 10, TIMES[10]))
    swapped = TIMES.copy()
    swapped[[50, 51]] = swapped[[51, 50]]
    with pytest.raises(DataError, match="frame 49"):
        check_times(swapped)
    with pytest.raises(DataError, match="no frames"):
        check_times(TIMES[:0])
    with pytest.raises(DataError, match="out of order"):
        check_times(TIMES[1::-1])


def test_lag_must_fit_the_frames_and_the_window():
    assert lag_frames(0.1, 0.025) == 4
    with pytest.raises(DataError, match="not a multiple of the frame interval"):
        lag_frames(0.03, 0.025)
    assert whole_steps(201, 8) == 25
    with pytest.raises(
        DataError, match=r"lag of 7 frames does not divide the window of 200 .*4 intervals earlier"
    ):
        whole_steps(201, 7)
    with pytest.raises(DataError, match="holds no step"):
        whole_steps(4, 4)
    with pytest.raises(DataError, match="at least one"):
        whole_steps(4, 0)


def test_unequal_particle_sets_are_refused():
    cells = np.zeros((3, 5), np.int32)
    with pytest.raises(DataError, match=r"x_m has the shape \(3, 4\), \(3, 5\)"):
        Frames(TIMES[:3], np.zeros((3, 4)), np.zeros((3, 5)), cells)


def test_a_part_keeps_the_interval():
    frames = Frames(TIMES[:9], np.zeros((9, 2)), np.ones((9, 2)), np.zeros((9, 2), np.int32))
    part = frames.part(slice(2, 5))
    assert part.cells.shape == (3, 2) and part.vx_m_s is None
    assert part.interval_s == pytest.approx(0.025)
