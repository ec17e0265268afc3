# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of the protocol: candidates, windows and starts, runs and repeats, kept results."""

import numpy as np
import pytest

from bedchain.studies.scan import at_frames


def test_curves_between_steps_are_straight():
    curves = np.array([[1.0, 1.0], [0.5, 0.8], [0.4, 0.7]])
    found = at_frames(curves, 2, 3)
    assert found[:, 0] == pytest.approx([1, 0.75, 0.5, 0.45])
    assert found.shape == (4, 2)
