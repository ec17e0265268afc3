# SPDX-License-Identifier: GPL-3.0-or-later
"""Marks of a case to the table and the figure: light particles that rise and heavy ones that sink."""

import numpy as np
import pandas as pd
import pytest

from bedchain.comparison.segregation import Mixture, segregation_table
from bedchain.figures.style import FigureFiles
from bedchain.trajectory.grid import Grid
from plot_segregation import plot_segregation

GRID, INTERVAL_S = Grid(0.01, 0.06, 1, 6), 0.1


@pytest.fixture(scope="module")
def mixture():
    """Two kinds of walkers on six rows; one prefers to go up, the other down; mixed at first."""
    rng, number, n_frames = np.random.default_rng(3), 600, 160
    light = np.arange(number) < 200
    cells = np.empty((n_frames, number), np.int32)
    cells[0] = rng.integers(0, 6, number)
    for frame in range(1, n_frames):
        draw = rng.random(number)
        up, down = np.where(light, 0.3, 0.2), np.where(light, 0.2, 0.3)
        cells[frame] = np.clip(cells[frame - 1] + (draw < up) - (draw > 1 - down), 0, 5)
    return Mixture(GRID, cells[60:], cells[:60], light, True, 1, INTERVAL_S)


def test_a_chain_for_each_kind_segregates_and_one_for_all_does_not(mixture, tmp_path):
    table = segregation_table("light", mixture, 5)
    means = table[(table["quantity"] == "lacey_index") & table["time_s"].isna()].set_index("source")
    assert means.loc["dem", "ci_high"] < 0.95 < means.loc["chain", "ci_low"]
    assert means.loc["chain_by_mark", "ci_low"] < means.loc["dem", "ci_high"]
    assert means.loc["chain_by_mark", "ci_high"] > means.loc["dem", "ci_low"]
    high = table[(table["quantity"] == "height_separation") & table["time_s"].isna()].set_index("source")[
        "value"
    ]
    assert high["dem"] > 0.2 and high["chain_by_mark"] == pytest.approx(high["dem"], abs=0.1)
    assert abs(high["chain"]) < 0.1
    table.to_csv(tmp_path / "s.csv", index=False)
    files = FigureFiles(tmp_path / "f.png", tmp_path / "f.pdf", tmp_path / "f.csv", 100)
    plot_segregation(
        tmp_path / "s.csv", files, {"dem": "#222222", "chain": "#ee6677", "chain_by_mark": "#4477aa"}
    )
    assert files.png.stat().st_size > 10_000 and len(pd.read_csv(files.csv)) == len(table)
