# SPDX-License-Identifier: GPL-3.0-or-later
"""The simulated bed as the truth: its own rows are at one floor, and repeats give the floor of the curves."""

import numpy as np
import pandas as pd
import pytest

from bedchain.case.load import load_case
from bedchain.measures.mixing import GROUPS
from bedchain.studies.ladder.answers import Truth, ladder_rows
from bedchain.studies.ladder.simulated import bed_answer, dem_rows, read_curves, truth_of
from bedchain.trajectory.grid import Grid
from made import ROOT
from made.frames import walkers


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


def test_a_cheaper_bed_is_measured_as_the_bed_itself_is():
    case = load_case(ROOT / "cases" / "short" / "case.yaml")
    case["bed"] |= {"width_m": 0.1, "height_m": 0.1}
    case |= {"cells": {"columns": 10, "rows": 10}, "mixing": {"split_x_m": 0.05, "split_z_m": 0.05}}
    case |= {"learning": {"start_s": 0.5, "end_s": 2.0}, "comparison": {"start_s": 2.0, "end_s": 4.0}}
    run, other = walkers(160), walkers(160, seed=6)
    times_s = run.times_s
    series = pd.DataFrame({"time_s": times_s, "pressure_drop_Pa": 1000 + 9 * np.sin(2 * np.pi * 4 * times_s)})
    spans, grid = (slice(20, 81), slice(80, 161)), Grid(0.1, 0.1, 10, 10)
    same, parcels = (bed_answer("bedFoam, parcels", bed, series, 3.0, case) for bed in (run, other))
    curves = np.concatenate([same.values["mixing_radial"], same.values["mixing_axial"]], axis=1)
    truth = truth_of(run, spans, series, curves[None], grid, case)
    errors = [ladder_rows([answer], truth).set_index("quantity")["error_1"] for answer in (same, parcels)]
    said = ["particle_height", "pressure_drop", "density", "mixing_radial", "mixing_axial", "stay_low"]
    assert errors[0][said].to_numpy() == pytest.approx(np.zeros(len(said)), abs=1e-12)
    assert (errors[1][[name for name in said if name != "pressure_drop"]] > 1e-4).all()
    assert (same.cost_s, same.paths) == (3.0, True)
