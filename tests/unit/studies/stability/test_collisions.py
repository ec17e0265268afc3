# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of spheres about to collide."""

import numpy as np
import pytest

from bedchain.studies.stability.collisions import Collision, pairs


def test_spheres_that_collide_start_apart_and_meet_at_all_parts_of_a_step():
    one = Collision(1e6, 1e-4, 0.1, 5e-4)
    left, right = pairs(one)[::2], pairs(one)[1::2]
    gaps = right[:, 0] - left[:, 0] - left[:, 4]
    assert (gaps > 0).all() and (left[:, 1] == right[:, 1]).all()
    assert gaps - gaps[0] == pytest.approx(np.arange(8) / 8 * 0.1 * 1e-4)
    assert left[:, 2] - right[:, 2] == pytest.approx(0.1)
