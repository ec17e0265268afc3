# SPDX-License-Identifier: GPL-3.0-or-later
"""Random walkers in a box."""

import numpy as np
import pytest

from bedchain.errors import DataError
from bedchain.studies.stability.walkers import HEIGHT, WIDTH, walkers, with_drain


def test_walkers_stay_in_the_box_and_remember_their_velocity():
    frames = walkers(41, 400)
    for place, size in ((frames.x_m, WIDTH), (frames.z_m, HEIGHT)):
        assert place.min() >= 0 and place.max() <= size
    assert walkers(5, 100, top=0.5).z_m.max() <= HEIGHT / 2
    same = np.corrcoef(frames.vx_m_s[0], frames.vx_m_s[1])[0, 1]
    assert 0.3 < same < 1
    drained = with_drain(frames)
    corner = (drained.x_m > 0.75 * WIDTH) & (drained.z_m > 0.75 * HEIGHT)
    assert (np.diff(corner.astype(int), axis=0) >= 0).all() and 0 < corner[-1].mean() < 1


def test_a_window_without_frames_is_refused():
    with pytest.raises(DataError, match="window is empty"):
        walkers(0, 10)
