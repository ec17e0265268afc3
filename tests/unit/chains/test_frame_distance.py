# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances between frames, against a loop."""

import numpy as np
import pytest

from bedchain.chains.frame_distance import frame_fields
from bedchain.trajectory.grid import Grid
from made.frames import kept_velocity


def test_distances_agree_with_a_plain_loop():
    frames = kept_velocity(300, 5, 0.1, 0.1, 0.1, seed=7)
    learned = frame_fields(frames, Grid(0.1, 0.1, 10, 10), 0.045)
    assert (learned.coarse.columns, learned.coarse.rows) == (2, 2)
    fields = np.zeros((5, 3, 4))
    for frame in range(5):
        for p in range(300):
            cell = int(frames.z_m[frame, p] >= 0.05) * 2 + int(frames.x_m[frame, p] >= 0.05)
            fields[frame, :, cell] += 1, frames.vx_m_s[frame, p], frames.vz_m_s[frame, p]
    scale = np.sqrt(((fields - fields.mean(axis=0)) ** 2).mean(axis=0).sum(axis=1))
    expected = [[np.sqrt((((a - b) / scale[:, None]) ** 2).sum()) for a in fields] for b in fields]
    assert learned.distances() == pytest.approx(np.array(expected), rel=1e-5, abs=1e-6)
    assert (learned.distances() ** 2).mean() == pytest.approx(6, rel=1e-5)
    assert learned.distances_from(learned.last_of(frames.part(slice(0, 4)))).argmin() == 3
