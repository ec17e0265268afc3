# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from scipy import sparse

from bedchain.chains import registry
from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.matrix_analysis import long_run_density
from bedchain.chains.passage import arrived, passage_time, residence_in_cells, top_row
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid

SOLVER = 1e-9


def column_of(matrix: sparse.csr_array, lag_s: float = 0.5) -> MarkovChain:
    """A static chain on one column of cells."""
    n = matrix.shape[0]
    cells = np.arange(n, dtype=np.int32)
    return MarkovChain(
        "static", Grid(0.01, 0.01 * n, 1, n), 1, lag_s, matrix, cells, 1, np.zeros(0, np.int64), 0
    )


def reflecting_walk(n: int) -> sparse.csr_array:
    dense = np.diag(np.full(n, 0.5)) + np.diag(np.full(n - 1, 0.25), 1) + np.diag(np.full(n - 1, 0.25), -1)
    dense[0, 0] = dense[-1, -1] = 0.75
    return sparse.csr_array(dense)


def test_residence_of_a_static_chain_is_that_of_its_states():
    chain = column_of(reflecting_walk(6))
    residence, density = residence_in_cells(chain, np.ones(6))
    assert residence == pytest.approx(0.5 / (1 - chain.matrix.diagonal()), rel=SOLVER)
    assert density == pytest.approx(long_run_density(chain.matrix, np.ones(6)), abs=SOLVER)


def test_residence_counts_a_cell_once_however_many_states_it_has():
    # Three frames in cell 0, one in cell 1, over and over: the dynamic chain knows it from pairs.
    cells = np.tile(np.array([0, 0, 0, 1]), 30)[:, None] + np.zeros((1, 4), int)
    cells = np.array([np.roll(cells[:, 0], shift) for shift in range(4)]).T.astype(np.int32)
    place = np.zeros(cells.shape)
    frames, grid = Frames(np.arange(120) * 0.1, place, place, cells), Grid(0.01, 0.02, 1, 2)
    chain = registry.learn("dynamic", frames, grid)
    start = np.bincount(chain.states(frames), minlength=chain.matrix.shape[0]).astype(float)
    residence, density = residence_in_cells(chain, start)
    assert residence == pytest.approx([0.3, 0.1], rel=0.02)
    assert density == pytest.approx([0.75, 0.25], abs=0.01)


def test_residence_without_a_way_out_is_infinite_and_without_particles_undefined():
    residence, density = residence_in_cells(column_of(sparse.csr_array(np.eye(3))), np.array([1.0, 1, 0]))
    assert residence[:2].tolist() == [np.inf, np.inf] and np.isnan(residence[2])
    assert density.tolist() == [0.5, 0.5, 0]


def test_passage_up_a_walk_by_hand():
    chain = column_of(reflecting_walk(5))
    start = np.array([3.0, 9, 0, 0, 0])
    # From the wall, k cells up a walk of 1/4 each way: 2 k (k + 1) steps of 0.5 s.
    assert passage_time(chain, start, 4) == pytest.approx(0.5 * 2 * 4 * 5)
    assert passage_time(chain, start, 1) == pytest.approx(0.5 * 2 * 1 * 2)


def test_passage_that_may_fail_or_has_no_particles():
    assert passage_time(column_of(sparse.csr_array(np.eye(3))), np.ones(3), 2) == np.inf
    assert np.isnan(passage_time(column_of(reflecting_walk(3)), np.array([0.0, 1, 1]), 2))


def test_top_row_by_hand():
    grid = Grid(0.02, 0.04, 2, 4)
    density = np.array([0.3, 0.3, 0.2, 0.1, 0.05, 0.03, 0.01, 0.01])
    assert top_row(density, grid, 0.1) == 2
    assert top_row(density, grid, 0.02) == 3
    assert top_row(density, grid, 0.001) == 3
    assert top_row(density, grid, 1.0) == 1


def test_arrivals_by_hand():
    grid = Grid(0.02, 0.03, 2, 3)
    cells = np.array([[0, 1, 0, 2], [2, 4, 1, 4], [0, 0, 5, 4]], np.int32)
    assert arrived(cells, grid, 2) == pytest.approx([0, 1 / 3, 2 / 3])
    assert np.isnan(arrived(cells + np.int32(2), grid, 2)).all()
