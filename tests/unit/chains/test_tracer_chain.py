# SPDX-License-Identifier: GPL-3.0-or-later
"""What is made of tracers' positions, for tracers that all go round the bed in a known way."""

import numpy as np
import pytest

from bedchain.chains.tracer_chain import TracerChain, reflect, start_places
from bedchain.errors import DataError
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid

GRID = Grid(0.4, 0.1, 4, 1)


class Shifted(TracerChain):
    """Tracers that move a cell to the right each step, and come in again on the left."""

    def walk(self, start, steps, rng):
        x, z = start_places(start, self.grid)
        for step in range(steps + 1):
            yield (x + 0.1 * step) % 0.4, z


@pytest.fixture
def chain():
    """Steps of a quarter of the bed."""
    return Shifted("shifted", GRID, 1, 5.0, {})


def at(x) -> Frames:
    x = np.array([x], float)
    return Frames(np.zeros(1), x, np.full(x.shape, 0.05), GRID.cell_of(x, np.full(x.shape, 0.05)))


def test_curves_follow_the_positions_and_cut_no_cell(chain):
    # one particle just right of the line, in a cell that the line cuts
    curves = chain.mixing(at([0.02, 0.16]), 0.15, 0.02, 4)
    assert curves[:, 0].tolist() == [1, 1, 0, 0, 1]
    assert curves[:, 1].tolist() == [1, 1, 1, 0, 1]
    assert np.isnan(curves[:, 2]).all() and (curves[:, 3] == 1).all()
    with pytest.raises(DataError, match="leaves one side empty"):
        chain.mixing(at([0.02]), 0.15, 0.2, 1)


def test_densities_are_numbers_of_particles_however_many_tracers(chain):
    marked = np.array([[True, True, False]])
    start = at([0.05, 0.06, 0.15])
    expected = chain.densities(start, marked, [1, 0])
    assert expected[:, 0].tolist() == [[0, 2, 0, 0], [2, 0, 0, 0]]
    drawn = chain.densities(start, marked, [1], np.random.default_rng(1))
    assert drawn.dtype == np.int64 and drawn[0, 0].tolist() == [0, 2, 0, 0]


def test_the_long_run_is_a_mean_over_steps(chain):
    # 4 steps of 5 s after the first 4: each cell once
    assert chain.long_run_density(at([0.05])).tolist() == [0.25] * 4


def test_reflection_by_hand():
    place = np.array([-0.25, 0.3, 1.2, 2.9, -3.5])
    reflect(place, 1.0)
    assert place == pytest.approx([0.25, 0.3, 0.8, 0.9, 0.5])


def test_a_start_on_a_wall_of_single_precision_is_inside():
    wall = np.array([[np.float32(0.4)]])
    assert wall.item() > 0.4
    x, _ = start_places(
        Frames(np.zeros(1), wall, np.full((1, 1), np.float32(0.05)), np.zeros((1, 1), int)), GRID
    )
    assert x[0] == 0.4
    with pytest.raises(DataError, match="outside"):
        start_places(Frames(np.zeros(1), wall + 0.01, np.zeros((1, 1)), np.zeros((1, 1), int)), GRID)
