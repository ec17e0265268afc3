# SPDX-License-Identifier: GPL-3.0-or-later
"""Candidates judged inside the learning window."""

import numpy as np
import pytest

from bedchain.measures.mixing import Splits
from bedchain.studies.candidates import Candidate
from bedchain.studies.scan import Task
from bedchain.studies.scores.selection import validated
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import Realisation
from made.frames import walkers


def task(grid: Grid) -> Task:
    return Task(grid, Splits(0.05, 0.05), "pooled", 5, 20)


def test_a_setting_that_the_window_is_too_short_for_is_a_problem_and_no_crash():
    run = walkers(60)
    for candidate, message in (
        (Candidate("static", 5, 5, 40), "lag 1 s is longer than the"),
        (Candidate("velocity_class", 5, 5, 1, {"earlier_s": 2.0}), "hold no step of 1 frames after 80"),
    ):
        result = validated(candidate, run, slice(0, 61), task(Grid(0.1, 0.1, 5, 5)))
        assert message in result["problem"] and np.isnan(result["validation_rms"])


def test_a_still_bed_is_followed_without_error_by_its_chain():
    values = np.tile(walkers(1).values[:1], (61, 1, 1))
    values[:, 2:] = 0
    run = Realisation("still", values, np.arange(61) * 0.025, 0.1, 0.1)
    # no cell is cut by the lines at 0.05 m
    result = validated(Candidate("static", 4, 4, 2), run, slice(0, 61), task(Grid(0.1, 0.1, 4, 4)))
    assert result["problem"] == "" and result["starts"] > 0
    assert (result["validation_rms"], result["ci_low"], result["ci_high"]) == pytest.approx(
        (0, 0, 0), abs=1e-12
    )
