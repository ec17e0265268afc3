# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves of marked particles, with particles that are not there; bands meet where nothing separates."""

import numpy as np

from bedchain.comparison.segregation import Mixture, curves, segregation_table
from bedchain.measures.marks import separation
from bedchain.trajectory.grid import OUTSIDE, Grid
from made.frames import hopping_cells

GRID = Grid(0.03, 0.04, 3, 4)


def test_curves_count_only_particles_that_are_there():
    cells, marked = hopping_cells(2), np.arange(200) < 80
    cells[3, :50] = OUTSIDE
    by_frame = curves(iter(cells), marked, GRID)
    held = [np.bincount(cells[3, 50:][which[50:]], minlength=12) for which in (marked, marked | True)]
    np.testing.assert_allclose(by_frame[3], separation(held[0], held[1], GRID.centres_m[:, 1]))
    assert by_frame.shape == (30, 3)


def test_a_mark_that_does_not_last_has_no_chain_of_its_own():
    cells = hopping_cells(5, n_frames=60)
    mixture = Mixture(GRID, cells[30:], cells[:30], cells[0] < 3, False, 1, 0.1)
    table = segregation_table("low", mixture, 1)
    assert set(table["source"]) == {"dem", "chain", "separated", "random"}
    chain = table[(table["source"] == "chain") & (table["quantity"] == "lacey_index")]
    dem = table[(table["source"] == "dem") & (table["quantity"] == "lacey_index")]
    assert chain["value"].iloc[0] == dem["value"].iloc[0]  # the same start
    assert (chain["ci_low"] <= chain["ci_high"]).all()
