# SPDX-License-Identifier: GPL-3.0-or-later
"""A belt of LIGGGHTS that is fed at one end and empties at the other: residence times by DEM and by chain."""

import numpy as np
import pytest

from bedchain.comparison.residence import of_chain, of_dem, residence_table
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid
from made.decks import run_deck

INTERVAL_S, FEED_1_S = 0.05, 80
SETTLED = 60  # frames until as many leave as enter


@pytest.fixture(scope="module")
def belt(tmp_path_factory):
    """Frames of the belt in its steady state, and the grid."""
    values, grid = (
        run_deck("in.conveyor", tmp_path_factory.mktemp("belt")).values[SETTLED:],
        Grid(0.12, 0.06, 24, 3),
    )
    cells = grid.cells_seen(values[:, 0], values[:, 1], may_leave=True)
    return Frames(INTERVAL_S * np.arange(len(values)), values[:, 0], values[:, 1], cells), grid


def test_residence_times_are_contents_over_throughput_and_alike_in_dem_and_chain(belt):
    frames, grid = belt
    half, times = len(frames.times_s) // 2, INTERVAL_S * np.arange(60)
    tables = {
        "dem": residence_table("dem", times, of_dem(frames.part(slice(half, None)), times)),
        "chain": residence_table(
            "chain", times, of_chain(frames.part(slice(0, half + 1)), grid.n_cells, 1, 59)
        ),
    }
    numbers = {name: table[table["time_s"].isna()].set_index("quantity") for name, table in tables.items()}
    for name, rows in numbers.items():
        low, high = rows.loc["mean", ["ci_low", "ci_high"]]
        assert low < rows.loc["contents_over_throughput", "value"] < high, name
        assert high - low < 0.15 * rows.loc["mean", "value"], name
        assert rows.loc["throughput", "value"] == pytest.approx(FEED_1_S, rel=0.05)
    # bands of two independent windows
    (low, high), (other_low, other_high) = (
        rows.loc["mean", ["ci_low", "ci_high"]] for rows in numbers.values()
    )
    assert max(low, other_low) < min(high, other_high)
    left = [table[table["quantity"] == "left_share"]["value"].to_numpy() for table in tables.values()]
    assert np.nanmax(np.abs(left[0] - left[1])) < 0.15
