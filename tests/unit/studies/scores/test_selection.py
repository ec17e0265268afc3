# SPDX-License-Identifier: GPL-3.0-or-later
"""Candidates judged inside the learning window."""

import numpy as np
import pandas as pd
import pytest

from bedchain.measures.mixing import Splits
from bedchain.studies.candidates import Candidate
from bedchain.studies.scan import Task
from bedchain.studies.scores.selection import disagreement, validated
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


def test_the_folds_are_summed_up():
    result = validated(Candidate("static", 4, 4, 2), walkers(60), slice(0, 61), task(Grid(0.1, 0.1, 4, 4)))
    folds = [result[f"fold_{number}"] for number in range(1, 6)]
    assert result["starts"] == 9 and result["problem"] == ""
    assert min(folds) < result["validation_rms"] < max(folds)
    assert result["ci_low"] < result["validation_rms"] < result["ci_high"]


def rows_of(*folds):
    """A table of static settings whose errors in the five folds are given."""
    columns = [f"fold_{number}" for number in range(1, 6)]
    rows = [dict(zip(columns, fold, strict=True)) | {"validation_rms": np.mean(fold)} for fold in folds]
    table = pd.DataFrame(rows).assign(model="static", cell_m=0.01)
    return table.assign(lag_s=[0.1 * (number + 1) for number in range(len(folds))])


def test_validation_that_disagrees_beyond_its_band_names_both_settings():
    table = rows_of([0.3, 0.31, 0.32, 0.3, 0.31], [0.1, 0.12, 0.11, 0.1, 0.1])
    words = disagreement(table, table.iloc[0])
    assert "0.01 m and 0.2 s (0.106)" in words and "0.01 m and 0.1 s (0.308) by the rule" in words
    assert disagreement(table, table.iloc[1]) == ""


def test_validation_within_its_band_says_nothing():
    table = rows_of([0.3, 0.2, 0.3, 0.1, 0.3], [0.1, 0.3, 0.2, 0.3, 0.2])
    assert disagreement(table, table.iloc[0]) == ""
