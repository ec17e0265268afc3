# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of the studies from made-up results."""

from pathlib import Path

import numpy as np
import pandas as pd

from bedchain.studies.readme import study_tables


def chain(**values: object) -> dict[str, object]:
    usual: dict[str, object] = {
        "half": "mcm",
        "axis": "cells and lag",
        "model": "static",
        "estimator": "pooled",
    }
    usual |= {"cell_width_m": 0.01, "cell_height_m": 0.01, "lag_s": 0.025, "tracers": 0, "cost_s": 0.004}
    usual |= {"learning_start_s": 1.5, "learning_end_s": 3.5, "preset": np.nan, "problem": np.nan}
    usual |= {"validation_error_1": 0.07, "validation_ci_low_1": 0.06, "validation_ci_high_1": 0.08}
    return usual | {"mixing_floors_1": 2.0, "density_floors_1": 1.0} | values


def write_tradeoff(folder: Path) -> None:
    rows = [
        chain(lag_s=0.1, preset="balanced accurate", mixing_floors_1=1.4),
        chain(cell_width_m=0.03, cell_height_m=0.03, lag_s=0.25, preset="fast", mixing_floors_1=1.5),
        chain(),
        chain(axis="window", learning_start_s=3.0, mixing_floors_1=6.0),
        chain(axis="window start", learning_end_s=2.0, mixing_floors_1=3.0),
        chain(axis="tracers", tracers=1000),
        chain(half="dem", axis="drag"),
    ]
    pd.DataFrame(rows).to_csv(folder / "tradeoff.csv", index=False)


def test_presets_are_held_against_what_another_run_has(tmp_path: Path) -> None:
    about = {
        "model": "static",
        "cell_m": 0.01,
        "lag_s": 0.2,
        "cost_s": 0.1,
        "ci_low_1": 1.0,
        "ci_high_1": 1.3,
    }
    rows = [
        {"chain": "another DEM run", "over_spread_1": 1.414, "over_floor_1": 1.48},
        {"chain": "the DEM's own learning window", "over_spread_1": 1.75, "ci_low_1": 1.0, "ci_high_1": 1.3},
        about | {"chain": "balanced", "over_spread_1": 1.1, "over_floor_1": 1.4},
        about | {"chain": "static", "over_spread_1": 1.1, "over_floor_1": 1.6},
        about | {"chain": "fast", "over_spread_1": 1.7, "over_floor_1": np.nan, "ci_low_1": np.nan},
        about | {"chain": "dynamic", "over_spread_1": 1.8, "ci_low_1": np.nan},
        {"chain": "too fine", "problem": "no such cells"},
    ]
    pd.DataFrame(rows).to_csv(tmp_path / "preset_errors.csv", index=False)
    table = study_tables.preset_errors(tmp_path)
    than_learned = "no worse than the learning window"
    verdicts = ["", "", "yes", "not from the single start", than_learned, "no", "no such cells"]
    assert list(table["no worse than another run"]) == verdicts
    assert table["model, cells, lag"][2] == "static, 1 cm, 0.2 s" and table["cost"][2] == "0.1 s"
    assert list(table["95 % band"]) == ["", *["1 to 1.3"] * 3, "", "", ""]


def test_windows_and_maps_hold_their_own_rows_only(tmp_path: Path) -> None:
    write_tradeoff(tmp_path)
    assert list(study_tables.learning_windows(tmp_path)["learned from"]) == ["1.5 to 2 s", "3 to 3.5 s"]
    table = study_tables.mixing_by_cell_and_lag(tmp_path)
    assert list(table["cell"]) == ["1 cm", "3 cm"]
    assert list(table.iloc[0])[1:] == ["2.00", "1.40", ""]
    assert set(study_tables.density_by_cell_and_lag(tmp_path).iloc[1, 1:]) == {"1.00", ""}


def test_variants_name_what_they_change_most(tmp_path: Path) -> None:
    (tmp_path / "figures").mkdir()
    row = {
        "axis": "drag",
        "variant": "drag_x",
        "changed": "drag x",
        "problem": "",
        "cost_s": 1,
        "cost_over_base_1": 1.04,
    }
    row |= {"mixing_floors_1": 1.5, "bed_height_floors_1": -3.0, "largest_floors_1": 3.0, "front": 0}
    pd.DataFrame([row]).to_csv(tmp_path / "figures/fig_tradeoff_dem.csv", index=False)
    assert list(study_tables.variants(tmp_path).iloc[0]) == ["drag x", "3", "bed height", "1.5", "1.04"]


def test_cheaper_beds_stand_beside_the_bed_itself(tmp_path: Path) -> None:
    floors = {f"{name}_floors_1": 1.5 for name in study_tables.CHANGES}
    rows = [
        {"half": "dem", "axis": "realisation", "variant": "base", "cost_s": 8.0} | floors,
        {"half": "dem", "axis": "parcels", "variant": "parcels_2", "changed": "l 2", "cost_s": 2.0} | floors,
        {"half": "dem", "axis": "drag law", "variant": "drag_x", "changed": "x", "cost_s": 8.0} | floors,
        {"half": "mcm", "axis": "parcels", "variant": "", "cost_s": 8.0} | floors,
    ]
    pd.DataFrame(rows).to_csv(tmp_path / "tradeoff.csv", index=False)
    table = study_tables.cheaper_beds(tmp_path)
    assert list(table["bed"]) == ["the bed itself", "l 2"] and list(table["cost"]) == ["1", "0.25"]
    assert set(table.iloc[1, 2:]) == {"1.5"}


def test_scores_are_those_in_the_repeats(tmp_path: Path) -> None:
    names = ["model", "cell_m", "lag_s", "options", "quantity", "time_s", "value", "window"]
    rows = [
        ["dem", np.nan, np.nan, np.nan, f"spread_{side}", np.nan, 0.04, "repeats"]
        for side in ("radial", "axial")
    ]
    for side in ("radial", "axial"):
        rows += [["static", 0.01, 0.1, np.nan, f"error_rms_{side}", np.nan, 0.05, "repeats"]]
        rows += [["static", 0.01, 0.1, np.nan, f"error_rms_{side}", 0.5, 9.0, "repeats"]]
        rows += [["static", 0.01, 0.1, np.nan, f"error_rms_{side}", np.nan, 9.0, "starts"]]
    pd.DataFrame(rows, columns=names).to_csv(tmp_path / "scores.csv", index=False)
    table = study_tables.scores(tmp_path)
    assert table.to_numpy().tolist() == [
        ["dem: noise floor", "0.04", "0.04"],
        ["static: 1 cm, 0.1 s", "0.05", "0.05"],
    ]


def test_stability_counts_outcomes(tmp_path: Path) -> None:
    rows = [("stable", "on"), ("stable", "on"), ("refused", "on"), ("inaccurate", "step")]
    pd.DataFrame(rows, columns=["outcome", "guards"]).to_csv(tmp_path / "stability.csv", index=False)
    table = study_tables.stability(tmp_path).set_index("outcome")
    assert list(table.loc["stable"]) == ["2", "0"]
    assert list(table.loc["inaccurate"]) == ["0", "1"]


def test_validation_verification_peers_and_benchmark(tmp_path: Path) -> None:
    columns = ["quantity", "source", "value", "unit", "ci_low", "ci_high", "aim", "met"]
    rows = [["voidage_rms", "dem", 0.0681, "1", 0.05, 0.09, 0.05, "no"],
            ["asymmetry", "measured", 0.0154, "1", np.nan, np.nan, np.nan, ""]]  # fmt: skip
    pd.DataFrame(rows, columns=columns).to_csv(tmp_path / "validation_metrics.csv", index=False)
    table = study_tables.validation(tmp_path)
    assert list(table.iloc[0]) == ["voidage rms", "dem", "1", "0.0681", "0.05 to 0.09", "0.05", "no"]
    assert list(table.iloc[1])[3:] == ["0.0154", "", "", ""]
    pd.DataFrame([["u [m/s]", 0.77, 0.0123, 0.75, 0.1, "yes", "Ergun"],
                  ["lost [1]", 0, np.nan, 0, 0, "yes", "count"]],
                 columns=["quantity", "value", "error", "reference", "tolerance", "pass", "source"]).to_csv(
        tmp_path / "verification.csv", index=False)  # fmt: skip
    assert list(study_tables.verification(tmp_path).iloc[0]) == [
        "u [m/s]",
        "0.77",
        "0.012",
        "0.75",
        "0.1",
        "yes",
        "Ergun",
    ]
    assert study_tables.verification(tmp_path)["error"][1] == ""
    peer = {"bed": "paper", "code": "Yade", "wall_s_per_simulated_s": 3195.2,
            "fastest_s_per_simulated_s": 2981.0,
            "slowest_s_per_simulated_s": 3272.0, "relative_to_bedfoam_1": 5.54,
            "pressure_drop_per_weight_1": np.nan,
            "mean_height_m": 0.2121, "simulated_s": 0.02, "differences": "no gas"}  # fmt: skip
    pd.DataFrame([peer]).to_csv(tmp_path / "peers.csv", index=False)
    assert list(study_tables.peers(tmp_path).iloc[0]) == [
        "paper", "Yade", "3195", "2981 to 3272", "5.54", "", "212.1 mm", "20 ms", "no gas"]  # fmt: skip
    task = {"work": "counts", "method": "bedchain", "particles": 81000, "columns": 27, "rows": 105,
            "median_s": 0.14, "cpu_s": 0.12,
            "peak_rss_mb": 339.2, "entries": 77726, "target": "", "met": ""}  # fmt: skip
    pd.DataFrame([task]).to_csv(tmp_path / "benchmark_core.csv", index=False)
    assert list(study_tables.benchmark(tmp_path).iloc[0])[2:] == [
        "81,000", "27 x 105", "0.14 s", "0.12 s", "339 MB", "77,726", "", ""]  # fmt: skip


def test_coverage_in_per_cent(tmp_path: Path) -> None:
    row = {
        "process": "mean",
        "correlation_times_1": 10.04,
        "covered_1": 0.9225,
        "samples_1": 2000,
        "windows_1": 40,
    }
    pd.DataFrame([row]).to_csv(tmp_path / "coverage.csv", index=False)
    (values,) = study_tables.coverage(tmp_path).to_numpy().tolist()
    assert values == ["mean", "10", "92.2 %", "2,000", "40"]
