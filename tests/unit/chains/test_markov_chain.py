# SPDX-License-Identifier: GPL-3.0-or-later
"""States of particles, and densities of a chain whose states share cells, by hand."""

import numpy as np
import pytest
from scipy import sparse

from bedchain.chains.markov_chain import MarkovChain
from bedchain.errors import DataError
from bedchain.trajectory.grid import Grid
from made.frames import framed

GRID = Grid(0.03, 0.01, 3, 1)
# after 0, 1 and after 2, 1; then one state a cell for all others
KEYS = np.array([0 * 3 + 1, 2 * 3 + 1])
GO_ON = [[0, 0, 0, 0, 1], [0, 0, 1, 0, 0], [0, 0, 1, 0, 0], [0, 0, 0.5, 0, 0.5], [0, 0, 0, 0, 1]]


@pytest.fixture
def chain():
    """Particles from 0 to 1 go on to 2, those from 2 to 1 go on to 0, others in 1 go either way."""
    matrix = sparse.csr_array(np.array(GO_ON, float))
    return MarkovChain("made", GRID, 2, 0.05, matrix, np.array([1, 1, 0, 1, 2], np.int32), 2, KEYS, 2)


def test_states_come_from_two_frames_one_lag_apart(chain):
    # the frame between the two is passed over
    frames = framed(np.array([[0, 2, 1, 1], [2, 2, 2, 2], [1, 1, 1, 0]]), GRID)
    assert chain.states(frames).tolist() == [0, 1, 3, 2]
    with pytest.raises(DataError, match="starts from 3 frames, 2 given"):
        chain.states(frames.part(slice(0, 2)))


def test_densities_add_the_states_of_a_cell(chain):
    start = framed(np.array([[0, 2, 1], [0, 2, 1], [1, 1, 1]]), GRID)
    everyone = np.ones((1, 3), bool)
    assert chain.densities(start, everyone, [0, 1])[:, 0].tolist() == [[0, 3, 0], [1.5, 0, 1.5]]
    assert chain.long_run_density(start).tolist() == [0.5, 0, 0.5]
    drawn = chain.densities(start, everyone, [1], np.random.default_rng(1))[0, 0]
    assert drawn.dtype == np.int64 and drawn[1] == 0 and drawn.sum() == 3


def test_a_cell_cut_by_a_line_counts_by_its_area(chain):
    start = framed(np.array([[0, 0], [0, 0], [1, 1]]), GRID)
    # both are right of 0.0125 m, and stay so
    right = chain.mixing(start, 0.0125, 0.005, 1)[:, 1]
    assert right.tolist() == [1.0, 1.0]
    # back in 0: that cell is whole on the left
    back = framed(np.array([[2, 2], [2, 2], [1, 1]]), GRID)
    assert chain.mixing(back, 0.0125, 0.005, 1)[1, 1] == pytest.approx(0)
    # with the line through cell 0, half of it is right
    assert chain.mixing(back, 0.005, 0.005, 1)[1, 1] == pytest.approx(0.5)


def test_arrays_give_the_chain_back_and_a_missing_one_is_named(chain):
    arrays = chain.arrays() | {"name": np.array("made")}
    again = MarkovChain.from_arrays(arrays)
    assert (again.matrix.toarray() == chain.matrix.toarray()).all() and again.grid == GRID
    assert (again.name, again.lag, again.lag_s, again.history, again.fallback) == ("made", 2, 0.05, 2, 2)
    del arrays["state_keys"]
    with pytest.raises(DataError, match="lacks 'state_keys': build the transitions again"):
        MarkovChain.from_arrays(arrays)
