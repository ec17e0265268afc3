# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain run from the starts held out: its batch between steps, and its displacements."""

import numpy as np
import pytest

from bedchain.chains import registry
from bedchain.measures.mixing import Splits
from bedchain.studies.scores.held_out import hold_out
from bedchain.studies.scores.predictions import batch_shares, dem_statistics, lagrangian_of
from bedchain.trajectory.grid import Grid
from made.frames import framed, walkers

GRID = Grid(0.1, 0.1, 5, 5)


def test_the_batch_between_two_steps_is_on_the_straight_line():
    # a step of four frames moves everything one cell up a column of five
    column = Grid(0.1, 0.1, 1, 5)
    cells = np.arange(5)[:, None] + np.zeros(3, int)
    frames = framed(np.repeat(cells, 4, axis=0), column)
    chain = registry.learn("static", frames, column, 4)
    batch = np.array([True, True, False])
    begin = frames.part(slice(0, 1))
    shares = batch_shares(chain, begin, batch, np.array([0, 3, 4, 6]), 4)
    expected = [[1, 0, 0], [0.25, 0.75, 0], [0, 1, 0], [0, 0.5, 0.5]]
    assert shares[:, :3] == pytest.approx(np.array(expected))
    assert batch_shares(chain, begin, batch, np.zeros(0, int), 4).shape == (0, 5)


def test_displacements_of_the_dem_and_of_a_chain_at_the_same_times():
    run, fine = walkers(120, n_particles=1000), Grid(0.1, 0.1, 20, 20)
    held = hold_out([run], GRID, (1.5, 3.0), 100, Splits(0.05, 0.05), 0.02, [0.1])
    chain = registry.learn("static", run.frames(fine, slice(0, 61)), fine)
    model, dem = lagrangian_of(chain, held, 0, 1, np.random.default_rng(1))
    assert (model.times_s == dem.times_s).all() and dem.times_s[0] == 0
    alone = dem_statistics(held, 0)
    assert (alone.squared_m2 == dem.squared_m2).all()
    values = run.values[60:].astype(float)
    at = int(np.argmin(np.abs(dem.times_s - 0.1)))
    lag = round(dem.times_s[at] / 0.025)
    moved = ((values[lag:, 0] - values[:-lag, 0]) ** 2).mean()
    # blocks of time have equal weight, whatever the number of displacements in them
    assert dem.squared_m2[:, at, 0].mean() == pytest.approx(moved, rel=0.1)
    # a chain without memory turns back at each step: slower
    assert model.squared_m2[:, at, 0].mean() < 0.8 * moved
