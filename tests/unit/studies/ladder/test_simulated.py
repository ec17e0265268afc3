# SPDX-License-Identifier: GPL-3.0-or-later
"""The simulated bed as the truth: its own rows are at one floor, and repeats give the floor of the curves."""

import numpy as np
import pandas as pd
import pytest

from bedchain.measures.mixing import GROUPS
from bedchain.studies.ladder.answers import Truth
from bedchain.studies.ladder.simulated import dem_rows, read_curves


def test_the_simulation_is_one_floor_from_another_realisation():
    truth = Truth({"particle_height": 0.2, "bubble_diameter": 0.05}, {"particle_height": 0.01}, 0.1)
    rows = dem_rows(truth, 100.0)
    assert rows["quantity"].tolist() == ["particle_height", "single_paths"]
    assert rows.loc[0, ["error_1", "error_floors"]].tolist() == [0.01, 1.0]


def test_curves_of_the_run_and_its_repeats(tmp_path):
    table = pd.DataFrame(
        [
            (time, source, direction, group, value)
            for source, value in (("dem", 0.5), ("dem_1", 0.7), ("static", 0.1))
            for time in (0.0, 0.1)
            for direction, group in GROUPS
        ],
        columns=["time_s", "source", "direction", "group", "fraction_remaining_1"],
    )
    table.to_csv(tmp_path / "mixing.csv", index=False)
    curves = read_curves(tmp_path / "mixing.csv")
    assert curves.shape == (2, 2, 4)
    assert np.unique(curves) == pytest.approx([0.5, 0.7])
