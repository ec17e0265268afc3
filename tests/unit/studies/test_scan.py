# SPDX-License-Identifier: GPL-3.0-or-later
"""The scan of settings: each measured once, in order; curves at frames; timing."""

import logging

import numpy as np
import pytest

from bedchain.measures.mixing import Splits
from bedchain.studies.candidates import Candidate
from bedchain.studies.marked_starts import Start
from bedchain.studies.scan import at_frames, named, observed_curves, scan, timed
from bedchain.trajectory.grid import Grid
from made.frames import walkers


def test_settings_are_measured_once_in_their_order_with_a_line_each(tmp_path, caplog):
    measured = []

    def measure(setting):
        measured.append(setting)
        return setting**2

    with caplog.at_level(logging.INFO, "bedchain"):
        assert scan([3, 1], measure, str, lambda result: f"gives {result}", tmp_path) == [9, 1]
    assert [message.split(";")[0] for message in caplog.messages] == [
        "1 of 2, 3: gives 9",
        "2 of 2, 1: gives 1",
    ]
    assert scan([1, 2, 3], measure, str, str, tmp_path) == [1, 4, 9] and measured == [3, 1, 2]
    assert scan([3], measure, str, str) == [9] and measured == [3, 1, 2, 3]


def test_a_candidate_is_named_by_its_own_cells_and_seconds():
    row = named(Candidate("jump", 20, 30, 4, {"classes": [3, 3]}), Grid(0.1, 0.3, 10, 10), 0.025)
    assert (row["model"], row["cell_m"], row["lag_s"]) == ("jump", pytest.approx(5e-3), pytest.approx(0.1))
    assert "classes" in row["options"]


def test_curves_between_steps_are_straight():
    curves = np.array([[1.0, 1.0], [0.5, 0.8], [0.4, 0.7]])
    found = at_frames(curves, 2, 3)
    assert found[:, 0] == pytest.approx([1, 0.75, 0.5, 0.45])
    assert found.shape == (4, 2)


def test_the_observed_curves_are_those_of_the_positions():
    run, start = walkers(20), Start(0, 0, 5, 15)
    curves = observed_curves(run, start, Splits(0.05, 0.05))
    left = run.values[5, 0] < 0.05
    assert curves.shape == (11, 4)
    assert curves[7, 0] == pytest.approx((run.values[12, 0][left] < 0.05).mean())


def test_a_kernel_is_timed_and_gives_what_it_makes():
    calls = []
    made, seconds = timed(lambda: calls.append(1) or "made")
    assert made == "made" and len(calls) == 4 and 0 <= seconds < 1
