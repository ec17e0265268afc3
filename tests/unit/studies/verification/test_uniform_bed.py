# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps of velocity through a lattice, and the pressure at the end of each."""

import re

import numpy as np
import pandas as pd
import pytest

from bedchain.studies.verification.uniform_bed import HOLD, RISE, VELOCITIES, held_pressure, steps_of_velocity


def test_each_velocity_is_reached_quickly_and_held():
    points = np.array(re.findall(r"\(([^\s()]+) ([^\s()]+)\)", steps_of_velocity()), float)
    times, speeds = points.T
    assert (np.diff(times) > 0).all() and times[-1] == pytest.approx(len(VELOCITIES) * HOLD)
    for step, velocity in enumerate(VELOCITIES):
        held = np.interp([step * HOLD + RISE, (step + 1) * HOLD], times, speeds)
        assert held == pytest.approx([velocity, velocity], rel=1e-5)


def test_the_pressure_is_taken_at_the_end_of_each_hold():
    times = np.linspace(0, len(VELOCITIES) * HOLD, 1201)
    table = pd.DataFrame({"time_s": times, "pressure_drop_Pa": 100 * times})
    assert held_pressure(table) == pytest.approx(100 * HOLD * np.arange(1, len(VELOCITIES) + 1))
