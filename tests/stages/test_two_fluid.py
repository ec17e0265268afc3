# SPDX-License-Identifier: GPL-3.0-or-later
"""The figure of a two-fluid run, of the archived one."""

import pandas as pd

from bedchain.case.load import load_case
from bedchain.case.two_fluid import two_fluid_case
from made import ROOT
from made.drawings import DPI, OnlyChecked
from plot_two_fluid import plot_two_fluid


def test_the_archived_run_is_drawn_with_what_is_behind_it(tmp_path):
    case = two_fluid_case(load_case(ROOT / "cases" / "paper" / "case.yaml"), 0.01)
    record = ROOT / "cases" / "paper" / "two_fluid" / "10mm" / "record.json"
    names = [tmp_path / f"fig.{form}" for form in ("png", "pdf", "csv")]
    plot_two_fluid(record, OnlyChecked(*names, DPI), tmp_path / "metrics.csv", case)
    metrics = pd.read_csv(tmp_path / "metrics.csv").set_index("quantity")["value"]
    carried = metrics[
        [f"{name}_over_weight" for name in ("gas_pressure", "solids_pressure", "momentum", "rest")]
    ]
    assert abs(carried.sum() - 1) < 1e-6 and 0.21 < metrics["mean_height"] < 0.22
    table = pd.read_csv(names[2])
    assert set(table["panel"]) == {"spectrum", "voidage", "radial", "axial"}
    voidage = table[table["panel"] == "voidage"]
    assert voidage.groupby("source")["y"].count().tolist() == [105, 105]
    solids = (1 - voidage["x"]).groupby(voidage["source"]).sum()
    # all particles are in both profiles
    assert abs(solids["two_fluid"] / solids["two_phase"] - 1) < 0.02
    assert abs(table.loc[table["panel"] == "spectrum", "y"].sum() - 1) < 1e-4
