# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps of modes and circulation, by hand."""

import numpy as np
import pytest

from bedchain.chains.circulation import circulation
from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.modes import slowest_modes
from bedchain.comparison.mode_maps import COLUMNS, excess, mode_maps, mode_rows
from bedchain.trajectory.grid import Grid
from made.matrices import reflecting_walk, ring


def chain_of(matrix, grid):
    """Chain of two states in each cell, which move alike."""
    dense = np.kron(matrix.toarray(), np.full((2, 2), 0.5))
    cells = np.repeat(np.arange(grid.n_cells), 2).astype(np.int32)
    return MarkovChain("static", grid, 1, 0.1, type(matrix)(dense), cells, 1, np.zeros(0, np.int64), 0)


def test_a_column_mixes_by_its_cosine():
    chain = chain_of(reflecting_walk(8), Grid(0.1, 0.8, 1, 8))
    modes = slowest_modes(chain.matrix, 3)
    flow = circulation(chain, modes.density)
    shape = np.cos(np.pi * (np.arange(8) + 0.5) / 8)
    assert np.abs(excess(chain, modes, 0)) == pytest.approx(np.abs(shape / shape[0]))
    table = mode_maps(chain, modes, flow)
    assert tuple(table.columns) == COLUMNS and len(table) == 8 * (2 + 2 + 4)
    assert table.query("quantity == 'density'")["value"].to_numpy() == pytest.approx(1 / 8)
    assert table.query("quantity == 'flow_z'")["value"].abs().max() < 1e-15
    rows = {(row["quantity"], row.get("part")): row["value"] for row in mode_rows(chain, modes, flow)}
    assert ("mode_period", "1") not in rows and rows["net_flux_share", None] < 1e-12


def test_a_ring_has_a_period_and_a_pair_is_one_process():
    chain = chain_of(ring(8, 0.75), Grid(0.8, 0.1, 8, 1))
    modes = slowest_modes(chain.matrix, 4)
    flow = circulation(chain, modes.density)
    rows = {(row["quantity"], row.get("part")): row for row in mode_rows(chain, modes, flow)}
    value = 0.25 + 0.75 * np.exp(2j * np.pi / 8)
    period = rows["mode_period", "1"]
    assert period["value"] == pytest.approx(2 * np.pi * 0.1 / np.angle(value)) and period["unit"] == "s"
    assert rows["net_flux_share", None]["value"] == rows["one_way_flux_share", None]["value"] == 1
    scales = mode_maps(chain, modes, flow).query("quantity == 'timescale'").groupby("part")["value"].first()
    # the second one of the maps is the next pair, not the other half of the first
    second = 0.25 + 0.75 * np.exp(4j * np.pi / 8)
    assert scales.to_numpy() == pytest.approx(-0.1 / np.log(np.abs([value, second])))
