# SPDX-License-Identifier: GPL-3.0-or-later
"""Candidates: their cells, their key and their options as text."""

from bedchain.studies.candidates import Candidate, grid_of
from bedchain.trajectory.grid import Grid


def test_a_candidate_has_its_own_cells_on_the_bed_of_the_case():
    assert grid_of(Candidate("static", 20, 30, 4), Grid(0.1, 0.3, 10, 10)) == Grid(0.1, 0.3, 20, 30)


def test_any_difference_makes_another_key():
    candidates = [
        Candidate("jump", 20, 30, 4), Candidate("jump", 30, 20, 4), Candidate("jump", 20, 30, 2),
        Candidate("static", 20, 30, 4), Candidate("jump", 20, 30, 4, {"classes": [3, 3]}),
        Candidate("jump", 20, 30, 4, {"classes": [3, 5]}),
    ]  # fmt: skip
    assert len({candidate.key for candidate in candidates}) == len(candidates)
    assert Candidate("jump", 20, 30, 4).key == candidates[0].key
    assert "classes" in candidates[-1].options_text and candidates[0].options_text == ""
