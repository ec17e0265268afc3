# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of a case from made-up results."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from bedchain.studies.readme import case_tables
from bedchain.studies.readme.case_tables import PARTS, number


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.104855, "0.105"),
        (2228.9, "2229"),
        (1.3e-14, "1.3e-14"),
        (81000.0, "81000"),
        (0.0, "0"),
        (np.nan, ""),
    ],
)
def test_numbers_have_three_digits(value: float, text: str) -> None:
    assert number(value) == text


def test_errors_stand_beside_another_dem_run(tmp_path: Path) -> None:
    rows = []
    for part in PARTS:
        rows += [(f"noise_floor_{part}", "dem", 0.05), (f"error_rms_{part}", "static", 0.10)]
        rows += [
            (f"error_rms_of_mean_{part}", "static", 0.08),
            (f"error_signed_of_mean_{part}", "static", -0.02),
        ]
        rows += [(f"error_rms_{part}", "static_monte_carlo", 0.11)]
    pd.DataFrame(rows, columns=["quantity", "source", "value"]).to_csv(tmp_path / "metrics.csv", index=False)
    table = case_tables.errors(tmp_path)
    assert list(table["chain"]) == ["another DEM run"] * 4 + ["static"] * 4
    assert list(table.iloc[0])[2:] == ["0.05", "0.0707", "1", "", ""]
    assert list(table.iloc[4])[2:] == ["0.05", "0.1", "1.41", "0.08", "-0.02"]


def test_bed_is_of_learning_and_comparison(tmp_path: Path) -> None:
    case = {"learning": {"start_s": 1.0}, "comparison": {"end_s": 2.0}}
    (tmp_path / "provenance.json").write_text(json.dumps({"case": {"values": case}}))
    pieces = [
        {"start_s": start, "end_s": start + 1, "wall_s": wall, "dem_s": 10.0, "exchange_s": 1.0, "gas_s": 2.0}
        for start, wall in ((0, 60.0), (1, 120.0))
    ]
    (tmp_path / "dem.json").write_text(json.dumps({"segments": pieces, "ranks": 2}))
    names = ("weight_on_gas_1", "weight_on_floor_1", "weight_on_sides_1", "mean_height_m",
             "smallest_voidage_1",
             "voidage_clips_1", "volume_balance_1", "exchange_error_1", "largest_overlap_1")  # fmt: skip
    early, late = dict.fromkeys(names, 9.0), dict.fromkeys(names, 0.25)
    pd.DataFrame([{"time_s": 0.5} | early, {"time_s": 1.5} | late]).to_csv(
        tmp_path / "bed_series.csv", index=False
    )
    values = case_tables.bed(tmp_path).set_index("quantity")["value"]
    assert values["window"] == "1 to 2 s"
    assert values["weight carried by the gas"] == "25.0 %"
    assert values["wall time of the whole run"] == "3 min"
    assert values["wall time of a simulated second: slowest segment"] == "120 s"
    assert values["gas and exchange over the particles' time"] == "0.3"
    assert "processor time of a simulated second" not in values  # a run by an earlier version
    timed = {"segments": [piece | {"cpu_s": 50.0} for piece in pieces], "ranks": 2}
    (tmp_path / "dem.json").write_text(json.dumps(timed))
    values = case_tables.bed(tmp_path).set_index("quantity")["value"]
    assert values["processor time of a simulated second"] == "50 s"


def test_costs_have_their_ratios(tmp_path: Path) -> None:
    wall = {"dem": 100.0}
    for model, factor in (("static", 1), ("dynamic", 5)):
        wall |= {f"{model}_{stage}": 0.1 * factor for stage in ("count", "matrix", "exact", "monte_carlo")}
    pd.DataFrame({"stage": list(wall), "wall_s": list(wall.values())}).to_csv(
        tmp_path / "timing.csv", index=False
    )
    values = case_tables.costs(tmp_path).set_index("quantity")["value"]
    assert values["DEM and gas, comparison window"] == "100 s"
    assert values["dynamic chain: counts"] == "500 ms"
    assert values["static: DEM over chain"] == "333 times"
    assert values["dynamic: matrix over static matrix"] == "5 times"


def test_steadiness_counts_the_rows_that_drift(tmp_path: Path) -> None:
    columns = [
        "quantity",
        "height_m",
        "mean",
        "drift",
        "ci_low",
        "ci_high",
        "unit",
        "block_s",
        "stationary_1",
    ]
    rows = [["particle_height", np.nan, 0.2, 0.001, -0.01, 0.01, "m", 0.5, 1],
            ["voidage", 0.1, 0.5, 0.3, -0.1, 0.1, "1", 0.5, 0],
            ["voidage", 0.2, 0.5, 0.0, -0.1, 0.1, "1", 0.5, 1]]  # fmt: skip
    pd.DataFrame(rows, columns=columns).to_csv(tmp_path / "stationarity.csv", index=False)
    table = case_tables.steadiness(tmp_path)
    assert list(table["quantity"]) == ["particle height", "voidage of 2 rows of cells"]
    assert table["drift"].iloc[1] == "1 of 2 beyond their interval"


def test_cells_and_lags_are_in_noise_floors(tmp_path: Path) -> None:
    rows = [("noise_floor", "dem", np.nan, np.nan, part, 0.1) for part in PARTS]
    rows += [("error_rms", "static", 0.01, lag, part, 0.2 * lag) for lag in (0.5, 1.0) for part in PARTS]
    rows += [("error_rms", "dynamic", 0.01, 0.5, part, 9.0) for part in PARTS]
    names = ["quantity", "source", "cell_m", "lag_s", "part", "value"]
    pd.DataFrame(rows, columns=names).to_csv(tmp_path / "discussion.csv", index=False)
    table = case_tables.cells_and_lags(tmp_path)
    assert table.to_dict("records") == [{"cell": "1 cm", "lag 0.5 s": "1.00", "lag 1 s": "2.00"}]


def test_summary_is_relative_to_another_dem_run(tmp_path: Path) -> None:
    claimed = [("dem_time", "dem", 20, 0.6), ("dem_over_chain_time", "static", 80, 5000.0),
               ("dynamic_over_static_time", "dynamic", 1000, 6.0)]  # fmt: skip
    pd.DataFrame(claimed, columns=["quantity", "source", "paper", "ours"]).to_csv(
        tmp_path / "agreement.csv", index=False
    )
    case = {
        "bed": {"width_m": 0.1, "height_m": 0.4},
        "cells": {"columns": 10, "rows": 40},
        "chain": {"lag_s": 0.025},
    }
    (tmp_path / "provenance.json").write_text(json.dumps({"case": {"values": case}}))
    values = [("realisations", "dem", 3.0), ("share_mean_low", "dem", 0.647)]
    pd.DataFrame(values, columns=["quantity", "source", "value"]).to_csv(
        tmp_path / "metrics.csv", index=False
    )
    rows = [("noise_floor", "dem", np.nan, np.nan, part, 0.3) for part in PARTS]
    for name, lag, error in (("static", 0.025, 0.4), ("static", 0.1, 0.2), ("dynamic", 0.025, 0.3)):
        rows += [("error_rms", name, 0.01, lag, part, error * np.sqrt(4 / 3)) for part in PARTS]
    names = ["quantity", "source", "cell_m", "lag_s", "part", "value"]
    pd.DataFrame(rows, columns=names).to_csv(tmp_path / "discussion.csv", index=False)
    table = case_tables.summary(tmp_path)
    assert list(table["here"]) == ["65 %", "1.33", "0.667", "1", "0.6 h", "5000", "6"]
    values += [(f"noise_floor_{part}", "dem", 0.3) for part in PARTS]
    values += [(f"error_rms_of_mean_{part}", "chosen", 0.24 * np.sqrt(4 / 3)) for part in PARTS]
    pd.DataFrame(values, columns=["quantity", "source", "value"]).to_csv(
        tmp_path / "metrics.csv", index=False
    )
    pd.DataFrame([("lag_s", 0.3), ("cell_m", 0.03)], columns=["quantity", "value"]).to_csv(
        tmp_path / "choice.csv", index=False
    )
    table = case_tables.summary(tmp_path)
    assert list(table["here"]) == ["65 %", "1.33", "0.667", "1", "0.8", "0.6 h", "5000", "6"]
    assert (
        table["quantity"][4] == "error of the chosen chain over another DEM run's, lag 0.3 s, cells of 3 cm"
    )


def test_claims_keep_their_reasons(tmp_path: Path) -> None:
    row = {"claim": "half, crossed", "where": "Fig. 5", "quantity": "q", "source": "dem", "paper": 0.5,
           "ours": 0.5626, "unit": "1", "tolerance": 0.1, "within": "yes", "why": "mixed"}  # fmt: skip
    pd.DataFrame([row]).to_csv(tmp_path / "agreement.csv", index=False)
    assert list(case_tables.agreement(tmp_path).iloc[0]) == [
        "half, crossed",
        "0.5",
        "0.563",
        "1",
        "yes",
        "mixed",
    ]


def test_models_of_the_ladder_are_cheapest_first_with_blanks_for_what_they_cannot_say(tmp_path):
    rows = [
        ("bedFoam", "pressure_drop", 1.0, 400.0, 300.0),
        ("static", "mixing_axial", 0.8, 0.001, 120.0),
        ("static", "single_paths", np.nan, 0.001, 120.0),
    ]
    columns = ["model", "quantity", "error_floors", "cost_s_per_s", "memory_mb"]
    pd.DataFrame(rows, columns=columns).to_csv(tmp_path / "ladder.csv", index=False)
    table = case_tables.ladder(tmp_path)
    assert table["model"].tolist() == ["static", "bedFoam"] and table["MB"].tolist() == ["120", "300"]
    assert table["mixing axial"].tolist() == ["0.8", ""] and table["pressure drop"].tolist() == ["", "1"]
