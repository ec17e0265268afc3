# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of diagnostics.csv, by hand."""

import numpy as np
import pytest

from bedchain.chains import registry
from bedchain.chains.counting import count_moves
from bedchain.comparison import diagnostics
from bedchain.comparison.metrics import metric
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid
from made.frames import framed

GRID = Grid(0.02, 0.03, 2, 3)


def by(rows, *keys):
    return {tuple(row.get(key, "") for key in keys): row["value"] for row in rows}


def test_a_table_has_its_columns_and_empty_places_where_nothing_was_given():
    table = diagnostics.table([metric("leak", "static", 0.5, part="literal")])
    assert tuple(table.columns) == diagnostics.COLUMNS
    assert table.loc[0, ["quantity", "part", "value", "unit"]].tolist() == ["leak", "literal", 0.5, "1"]
    assert table[["lag_s", "time_s", "height_m", "ci_low", "ci_high"]].isna().all(axis=None)


def test_estimators_of_both_chains():
    # cell 1 is empty in every other step: literal loses half of its row
    frames = framed(np.array([[0, 0], [1, 0], [0, 0], [1, 0], [0, 0]]), GRID)
    rows = diagnostics.estimator_rows(
        frames, GRID, count_moves(frames.cells, GRID.n_cells), ["static", "dynamic", "jump"]
    )
    value = by(rows, "quantity", "source", "part")
    assert {row["source"] for row in rows} == {"static", "dynamic"} and len(rows) == 18
    assert value["row_sum_error", "static", "literal"] == pytest.approx(0.5)
    # cell 1 holds 2 of 8 particles at the starts
    assert value["leak", "static", "literal"] == pytest.approx(0.25 * 0.5)
    assert value["leak", "static", "pooled"] == value["row_sum_error", "dynamic", "pooled"] == 0
    assert value["long_run_total_variation", "static", "pooled"] == pytest.approx(0, abs=1e-12)


def test_times_of_a_column_that_is_climbed_step_by_step():
    # from each row to the next, and from the top to the bottom: half stay where they are
    grid = Grid(0.01, 0.03, 1, 3)
    cells = np.array([[0, 0, 1, 1, 2, 2], [0, 1, 1, 2, 2, 0]])
    chain = registry.learn("static", framed(cells, grid), grid)
    times, lag = diagnostics.times_of(chain, np.ones(3), 0.1, top=2), chain.lag_s
    rows = diagnostics.time_rows("static", lag, 0.02, times, times * np.linspace(0.9, 1.1, 5)[:, None])
    value = by(rows, "quantity", "part")
    for part in ("mean", "shortest", "longest"):
        assert value["residence_time", part] == pytest.approx(2 * lag)
    assert value["first_passage_time", ""] == pytest.approx(4 * lag)
    assert all(row["ci_low"] < row["value"] < row["ci_high"] for row in rows)


def test_a_bed_at_rest_has_neither_residence_nor_passage():
    grid = Grid(0.01, 0.03, 1, 3)
    still = registry.learn("static", framed(np.tile(np.arange(3), (3, 1)), grid), grid)
    times = diagnostics.times_of(still, np.ones(3), 0.1, top=2)
    assert np.isnan(times).all()
    assert diagnostics.time_rows("static", 0.1, 0.02, times, np.empty((0, 4))) == []


def test_arrivals_and_mixing_by_hand():
    frames = framed(np.array([[0, 1, 4], [2, 1, 4], [4, 3, 4]]), GRID)
    row = diagnostics.arrival_row("dem", frames, GRID, top=2)
    assert row["value"] == 0.5 and row["time_s"] == pytest.approx(0.05) and row["height_m"] == 0.02
    # apart at first, then each cell as the whole
    numbers = np.array([[[4, 0], [0, 4], [4, 0], [0, 4]], [[2, 2], [2, 2], [4, 0], [0, 4]]])
    indices = diagnostics.lacey_indices(numbers)
    rows = diagnostics.lacey_rows("dem", np.array([0.0, 1.0]), indices, np.empty(0))
    assert np.isnan([row["ci_low"] for row in rows]).all()
    value = by(rows, "part", "time_s")
    assert value["radial", 0.0] == value["axial", 1.0] == pytest.approx(0)
    assert value["radial", 1.0] == pytest.approx(0.25 / (0.25 - 0.0625))


def test_bands_of_indices_and_shares_hold_them_and_need_every_block():
    indices = np.array([[0.2, 0.5], [0.3, 0.9]])
    left_out = indices + 0.01 * np.arange(-2, 3)[:, None, None]
    rows = diagnostics.lacey_rows("static", np.array([0.0, 1.0]), indices, left_out)
    assert all(row["ci_low"] < row["value"] < row["ci_high"] for row in rows)
    share = diagnostics.share_row("static", 1.0, 0.02, 0.9, 0.9 + 0.02 * np.arange(-2, 3))
    assert 0 < share["ci_low"] < 0.9 < share["ci_high"] < 1  # on a logit scale
    assert np.isnan(diagnostics.share_row("dem", 1.0, 0.02, 0.9, np.empty(0))["ci_low"])


def test_particles_that_climb_a_row_with_one_half_arrive_as_two_heads_do():
    grid = Grid(0.01, 0.03, 1, 3)
    chain = registry.learn("static", framed(np.array([[0, 0, 1, 1, 2, 2], [0, 1, 1, 2, 2, 0]]), grid), grid)
    for steps, share in ((1, 0.0), (2, 0.25), (3, 0.5), (4, 11 / 16)):
        assert diagnostics.arrived_share(chain, np.array([4.0, 9.0, 9.0]), 2, steps) == pytest.approx(share)
    assert np.isnan(diagnostics.arrived_share(chain, np.array([0.0, 1.0, 1.0]), 2, 3))


def test_dispersion_rows_need_enough_displacements():
    rng = np.random.default_rng(1)
    x = np.cumsum(rng.normal(0, 0.1, (41, 30)), axis=0)
    z = np.where(np.arange(30) < 28, 0.005, 0.025) * np.ones(x.shape)
    frames = Frames(np.arange(41) * 0.025, x, z, np.zeros(x.shape, np.int32))
    rows = diagnostics.dispersion_rows("dem", frames, GRID, [1])
    assert np.isnan([row["ci_low"] for row in rows]).all()
    banded = diagnostics.dispersion_rows("dem", frames, GRID, [1], 20.0)
    assert [row["value"] for row in banded] == [row["value"] for row in rows]
    ends = {row["quantity"]: (row["ci_low"], row["ci_high"]) for row in banded}
    assert ends["dispersion_x"][0] < 0.01 / 0.05 < ends["dispersion_x"][1]
    # 2 x 40 displacements in the top row are too few
    assert {row["height_m"] for row in rows} == {0.005}
    value = by(rows, "quantity")
    assert value[("dispersion_z",)] == 0
    assert value[("dispersion_x",)] == pytest.approx(0.01 / 0.05, rel=0.1)
