# SPDX-License-Identifier: GPL-3.0-or-later
"""Candidates judged inside the learning window."""

import numpy as np
import pandas as pd
import pytest

from bedchain.measures.mixing import Splits, remaining_from_positions, side_shares, sides
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


def test_each_block_is_predicted_by_a_chain_that_has_not_seen_it():
    run, where = walkers(60), task(Grid(0.1, 0.1, 4, 4))
    result = validated(Candidate("static", 4, 4, 2), run, slice(0, 61), where)
    cells = run.frames(where.grid, slice(0, 61)).cells
    # the third block is frames 24 to 36; no step may have a frame inside it

    def matrix_of(lag):
        counts = np.zeros((16, 16))
        for start in (start for start in range(61 - lag) if start + lag <= 24 or start >= 36):
            np.add.at(counts, (cells[start], cells[start + lag]), 1)
        return counts / counts.sum(axis=1, keepdims=True)

    whole, half, errors = matrix_of(2), matrix_of(1), []
    shares = side_shares(where.grid, *where.splits)
    for begin in (24, 30):
        observed = remaining_from_positions(run.values[begin:37, 0], run.values[begin:37, 1], *where.splits)
        marked = sides(run.values[begin, 0], run.values[begin, 1], *where.splits)
        now = np.array([np.bincount(cells[begin][group], minlength=16) for group in marked], float)
        for frame in range(1, 37 - begin):
            now = now @ whole if frame % 2 == 0 else now
            share = ((now @ half if frame % 2 else now) * shares).sum(axis=1) / marked.sum(axis=1)
            errors.append((share - observed[frame]) ** 2)
    assert result["starts"] == 9 and result["problem"] == ""
    assert result["fold_3"] == pytest.approx(np.sqrt(np.mean(errors)))
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
