# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains that the protocol tries."""

import pytest

from bedchain.chains.registry import LEARNERS, learn
from bedchain.studies.candidates import Candidate, grid_of
from bedchain.studies.scores.search_spaces import SEARCH_SPACES, candidates, scaled
from bedchain.trajectory.grid import Grid
from made.frames import stirred

GRID = Grid(0.27, 1.05, 27, 105)


def test_all_models_are_tried_with_the_case_itself_among_the_static_ones():
    tried = candidates(LEARNERS, GRID, 2, 1e-3)
    assert set(LEARNERS) <= {one.name for one in tried}
    assert Candidate("static", 27, 105, 2) in tried
    assert len({one.key for one in tried}) == len(tried)
    assert {one.lag for one in tried if one.model == "static"} == {2, 4, 8, 16}


def test_every_option_tried_is_one_of_its_model():
    frames, grid = stirred(3, n_frames=40)
    tried = {(one.model, one.options_text): one for one in candidates(LEARNERS, grid, 1, 1e-3)}
    assert len(tried) > len(LEARNERS)
    for one in tried.values():
        learn(one.model, frames, grid, **one.options)


def test_baselines_compete_as_models_of_their_own():
    names = {one.name for one in candidates(LEARNERS, GRID, 1, 1e-3) if one.model == "recurrence"}
    assert names == {"recurrence", "recurrence_shuffled", "recurrence_replay"}
    assert set(SEARCH_SPACES) <= set(LEARNERS)


def test_cells_finer_than_a_particle_are_left_out():
    for columns, kept in ((50, {50, 100}), (80, {80})):
        tried = candidates(["dynamic"], Grid(0.1, 0.1, columns, columns), 1, 1e-3)
        assert {grid_of(one, GRID).columns for one in tried} == kept


def test_scaled_cells_are_nearly_square():
    grid = scaled(GRID, 2)
    assert (grid.columns, grid.rows) == (14, 52)
    assert grid.cell_width_m == pytest.approx(grid.cell_height_m, rel=0.05)
