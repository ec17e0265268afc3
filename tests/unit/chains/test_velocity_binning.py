# SPDX-License-Identifier: GPL-3.0-or-later
"""Velocities and their classes."""

import numpy as np
import pytest

from bedchain.chains import velocity_binning
from bedchain.trajectory.frames import Frames
from made.frames import kept_velocity

WIDTH, MEMORY, SPEED = 0.1, 0.15, 0.1


def test_classes_hold_equally_many_and_are_told_apart_at_their_edges():
    frames = kept_velocity(5000, 30, WIDTH, MEMORY, SPEED, seed=4)
    classes = velocity_binning.quantile_classes(frames, (3, 4))
    shares = np.bincount(classes.of(frames).ravel(), minlength=12) / frames.x_m.size
    assert classes.number == 12 and shares == pytest.approx(np.full(12, 1 / 12), rel=0.1)
    edges = velocity_binning.VelocityClasses(np.array([-0.1, 0.1]), np.zeros(0))
    vx = np.array([[-0.2, -0.1, 0.0, 0.1, 0.3]])
    place = np.zeros(vx.shape)
    one = Frames(np.zeros(1), place, place, place.astype(np.int32), vx, place)
    assert edges.of(one).tolist() == [[0, 1, 1, 2, 2]]


def test_velocities_that_are_missing_are_differences():
    frames = kept_velocity(50, 6, WIDTH, MEMORY, SPEED, seed=5)
    blank = np.full(frames.x_m.shape, np.nan)
    for vx in (None, blank):
        bare = Frames(frames.times_s, frames.x_m, frames.z_m, frames.cells, vx, vx)
        found = velocity_binning.velocities(bare)
        assert not velocity_binning.measured(bare)
        assert found[0][3] == pytest.approx((frames.x_m[3] - frames.x_m[2]) / 0.025)
        assert (found[1][0] == found[1][1]).all()
    assert velocity_binning.measured(frames)
