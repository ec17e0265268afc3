# SPDX-License-Identifier: GPL-3.0-or-later
"""A saved chain run from another start, against its own matrix and the frames of the bed."""

import dataclasses

import numpy as np
import pandas as pd
import pytest

from apply_chain import Start, apply_chain
from bedchain.chains import registry
from bedchain.chains.between_steps import learn_fractions
from bedchain.errors import UserError
from bedchain.measures.mixing import remaining_from_cells, side_shares, sides
from bedchain.trajectory.cell_store import open_cells
from bedchain.trajectory.frames import Frames
from made.figure_beds import SHAPES, TIMES, figure_bed

SHAPE, LAG = SHAPES["short"], 2


@pytest.fixture(scope="module")
def learned(tmp_path_factory):
    """A bed that rolls, and a chain with steps of two frames learned from its first half."""
    results = figure_bed(tmp_path_factory.mktemp("rolling"), SHAPE)
    store = open_cells(results / "cells.npz")
    values = np.load(results / "trajectory.npy")
    half = slice(0, 40)
    frames = Frames(TIMES[half], values[half, 0], values[half, 1], np.asarray(store.cells[half]))
    chain = registry.learn("static", frames, store.grid, LAG)
    fractions = learn_fractions(frames, store.grid.n_cells, LAG)
    registry.save(chain, results / "transitions_static.npz", fractions)
    return results


def test_the_chain_moves_the_shares_of_the_marked_particles(learned):
    folder = apply_chain(learned / "transitions_static.npz", learned, Start("low", 2.0, 0.5))
    table = pd.read_csv(folder / "applied.csv")
    store, values = open_cells(learned / "cells.npz"), np.load(learned / "trajectory.npy")
    at = int(np.argmin(np.abs(TIMES - 2.0)))
    split_z_m = float(values[at, 1].mean())
    marked = values[at, 1] < split_z_m
    matrix = registry.load(learned / "transitions_static.npz").matrix
    on = side_shares(store.grid, SHAPE.width / 2, split_z_m)[2]
    share = np.bincount(store.cells[at][marked], minlength=store.grid.n_cells) / marked.sum()
    expected = [share @ on]
    for _ in range(5):
        share = share @ matrix
        expected.append(share @ on)
    chain = table[table["source"] == "chain"]
    np.testing.assert_allclose(chain["remaining_1"][::LAG], expected, rtol=1e-6)
    np.testing.assert_allclose(chain["time_s"], TIMES[at : at + 11], rtol=1e-6)


def test_beside_it_stands_what_the_particles_did(learned):
    folder = apply_chain(learned / "transitions_static.npz", learned, Start("left", 2.5, 1.0, 0.04))
    table = pd.read_csv(folder / "applied.csv")
    store, values = open_cells(learned / "cells.npz"), np.load(learned / "trajectory.npy")
    at = int(np.argmin(np.abs(TIMES - 2.5)))
    marked = sides(values[at, 0], values[at, 1], 0.04, SHAPE.height / 2)
    shares = side_shares(store.grid, 0.04, SHAPE.height / 2)
    frames = remaining_from_cells(np.asarray(store.cells[at:]), marked, shares)[:, 0]
    dem = table[table["source"] == "dem"]
    np.testing.assert_allclose(dem["remaining_1"], frames, rtol=1e-6)
    assert len(dem) == 11 and len(table[table["source"] == "chain"]) == 21  # the frames end at 3 s
    cells = pd.read_csv(folder / "cells.csv")
    assert cells["dem_1"].isna().sum() == 10 * store.grid.n_cells
    np.testing.assert_allclose(cells.groupby("time_s")["chain_1"].sum(), 1, rtol=1e-6)


def test_a_start_that_cannot_be_is_a_sentence(learned, tmp_path):
    chain = learned / "transitions_static.npz"
    with pytest.raises(UserError, match="missing"):
        apply_chain(tmp_path / "transitions_static.npz", learned, Start("low"))
    with pytest.raises(UserError, match="no particle .* is up of the line at 0.5 m"):
        apply_chain(chain, learned, Start("up", split_m=0.5))
    other = figure_bed(tmp_path, dataclasses.replace(SHAPE, width=0.2))
    with pytest.raises(UserError, match="0.2 m wide, the bed of .* 0.1 m"):
        apply_chain(chain, other, Start("all"))
    assert not (other / "applied").exists()
