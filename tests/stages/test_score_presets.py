# SPDX-License-Identifier: GPL-3.0-or-later
"""The presets' table on walkers whose velocity forgets itself in a known time."""

import numpy as np
import pandas as pd
import pytest

from bedchain.case.load import load_case
from bedchain.comparison.curves import curve_table
from bedchain.errors import UserError
from bedchain.files import write_csv
from bedchain.measures.mixing import Splits, remaining_from_positions
from bedchain.studies.preset_scores import EARLIER
from bedchain.trajectory.store import BedFiles
from made import ROOT
from made.persistent_walk import write_bed
from score_presets import score_presets

SIZE, FRAMES, START, END = 0.1, 121, 1.5, 3.0
FRAME_S = 0.025


@pytest.fixture(scope="module")
def bed(tmp_path_factory):
    """A run and a repeat of 1000 walkers, the repeat's curves, a choice of 0.25 s and 1 cm."""
    folder = tmp_path_factory.mktemp("presets")
    for seed, name in enumerate(("run", "repeat"), 1):
        write_bed(folder / name, FRAMES, 1000, SIZE, 0.2, 0.15, seed)
    values = np.load(folder / "repeat/trajectory.npy")[round(START / FRAME_S) :]
    curves = remaining_from_positions(values[:, 0], values[:, 1], *Splits(SIZE / 2, SIZE / 2))
    times = START + FRAME_S * np.arange(len(curves))
    write_csv(curve_table(times, "dem_1", curves), folder / "mixing.csv")
    (folder / "choice.csv").write_text("quantity,value,unit,why\nlag_s,0.25,s,\ncolumns,10,1,\nrows,10,1,\n")
    (folder / "presets.yaml").write_text("balanced: {cell_m: auto, lag_s: auto, model: static}\n")
    return folder


def scored(folder, learning_end_s=START, repeats=True):
    case = load_case(ROOT / "cases" / "short" / "case.yaml")
    case |= {
        "bed": case["bed"] | {"width_m": SIZE, "height_m": SIZE}, "cells": {"columns": 10, "rows": 10},
        "particles": case["particles"] | {"number": 1000},
        "learning": {"start_s": 0.0, "end_s": learning_end_s},
        "mixing": {"split_x_m": 0.05, "split_z_m": 0.05},
        "comparison": {"start_s": START, "end_s": END, "repeats": 1},
    }  # fmt: skip
    score_presets(
        BedFiles(folder / "run/trajectory.npy", folder / "run/trajectory.json"),
        [folder / "repeat/trajectory.npy"] if repeats else [], [folder / "mixing.csv"] if repeats else [],
        folder / "choice.csv", folder / "presets.yaml", folder / "table.csv", case,
    )  # fmt: skip
    return pd.read_csv(folder / "table.csv").set_index("chain")


def test_a_lag_that_forgets_the_velocity_is_seen_to_be_better(bed):
    table = scored(bed)
    assert list(table.index) == ["another DEM run", EARLIER, "static", "dynamic", "balanced"]
    # starts of one window share frames: their spread is a little small
    assert 2**0.5 < table["over_spread_1"][EARLIER] < 2
    assert table["over_spread_1"]["another DEM run"] == pytest.approx(2**0.5)
    assert table["over_spread_1"]["balanced"] < 0.5 * table["over_spread_1"]["static"]
    assert table["lag_s"]["balanced"] == 0.25 and table["cell_m"]["balanced"] == pytest.approx(0.01)
    starts = table["starts"].drop(EARLIER)
    assert (starts == starts.iloc[0]).all() and starts.iloc[0] % 2 == 0
    parts = table[["learn_s", "between_s", "run_s"]].sum(axis=1)[2:]
    assert parts.to_numpy() == pytest.approx(table["cost_s"][2:].to_numpy())
    over_floor = (table["single_error_1"] / table["noise_floor_1"]).to_numpy()
    assert table["over_floor_1"].to_numpy() == pytest.approx(over_floor)


def test_without_repeats_there_is_no_noise_floor(bed):
    table = scored(bed, repeats=False)
    assert table["noise_floor_1"].isna().all() and table["over_spread_1"].notna().all()


def test_a_test_inside_the_learning_window_is_refused(bed):
    with pytest.raises(UserError, match=r"inside the learning window.*learning\.end_s"):
        scored(bed, learning_end_s=2.0)
