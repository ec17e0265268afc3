# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of the studies for the README files: trade-off, scores, validation, verification and others.

Each function takes the folder of the results and gives texts as they are shown.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from bedchain.studies.readme.case_tables import by_cell_and_lag, number

CELLS_AND_LAGS, WINDOWS = "cells and lag", ("window", "window start")
# observables of the trade-off that the table of cheaper beds shows
CHANGES = {
    "mixing": "mixing curves",
    "density": "density",
    "bed_height": "height",
    "pressure_drop": "pressure drop",
    "dispersion_x": "dispersion across",
    "dispersion_z": "dispersion up",
    "granular_temperature": "granular temperature",
}
CHEAPER = ("realisation", "parcels", "combination")  # axes of the trade-off
# columns of scores.csv that tell chains apart
CHAIN = ["model", "cell_m", "lag_s", "options"]


def preset_errors(results: Path) -> pd.DataFrame:
    """Cost and errors of the case's own chains and of the presets, beside another DEM run."""
    table = pd.read_csv(results / "preset_errors.csv")
    another, earlier = table.iloc[0], table.iloc[1]
    rows = []
    for row in table.to_dict("records"):
        chain = f"{row['model']}, {100 * row['cell_m']:.2g} cm, {row['lag_s']:g} s"
        band = f"{number(row['ci_low_1'])} to {number(row['ci_high_1'])}"
        rows.append(
            {
                "chain": row["chain"],
                "model, cells, lag": chain if pd.notna(row["model"]) else "",
                "cost": f"{number(row['cost_s'])} s" if pd.notna(row["cost_s"]) else "",
                "error over the spread of starts": number(row["over_spread_1"]),
                "95 % band": band if pd.notna(row["ci_low_1"]) else "",
                "Fig. 5's start, noise floors": number(row["over_floor_1"]),
                "no worse than another run": _no_worse(row, another, earlier),
            }
        )
    return pd.DataFrame(rows)


def _no_worse(row: dict[str, Any], another: "pd.Series[Any]", earlier: "pd.Series[Any]") -> str:
    """Whether a chain errs no more than another run, over all starts and from one; or its problem.

    Where the flow has changed since the learning window, the DEM's own curves from there are another run too.
    """
    if pd.isna(row["model"]):
        return "" if pd.isna(row["problem"]) else str(row["problem"])
    if np.isnan(row["over_spread_1"]):
        return "one start: not known"
    if not row["over_spread_1"] <= another["over_spread_1"]:
        known = row["over_spread_1"] <= earlier["over_spread_1"]
        return "no worse than the learning window" if known else "no"
    return "yes" if not row["over_floor_1"] > another["over_floor_1"] else "not from the single start"


def mixing_by_cell_and_lag(results: Path) -> pd.DataFrame:
    """Error of the static chain's mixing curves over all realisations, in noise floors."""
    return _by_cell_and_lag(results, "mixing_floors_1")


def density_by_cell_and_lag(results: Path) -> pd.DataFrame:
    """Error of the static chain's density, in noise floors."""
    return _by_cell_and_lag(results, "density_floors_1")


def learning_windows(results: Path) -> pd.DataFrame:
    """Errors of the case's own chain learned from parts of the learning window."""
    table = _chains(results)
    parts = table[table["axis"].isin(WINDOWS)].sort_values(["learning_start_s", "learning_end_s"])
    spans = zip(parts["learning_start_s"], parts["learning_end_s"], strict=True)
    return pd.DataFrame(
        {
            "learned from": [f"{start:g} to {end:g} s" for start, end in spans],
            "mixing curves, noise floors": parts["mixing_floors_1"].map(number),
            "density, noise floors": parts["density_floors_1"].map(number),
        }
    )


def variants(results: Path) -> pd.DataFrame:
    """What each choice of the simulation changes at most, and its cost over that of the bed itself."""
    table = pd.read_csv(results / "figures" / "fig_tradeoff_dem.csv")
    observables = [name for name in table if name.endswith("_floors_1") and name != "largest_floors_1"]
    sizes = table[observables].abs().fillna(0)
    strongest = sizes.idxmax(axis=1).str.removesuffix("_floors_1").str.replace("_", " ")
    return pd.DataFrame(
        {
            "choice": table["changed"].fillna(table["variant"]),
            "largest change, noise floors": table["largest_floors_1"].map(number),
            "of": strongest,
            "mixing curves, noise floors": table["mixing_floors_1"].map(number),
            "cost": table["cost_over_base_1"].map(number),
        }
    )


def cheaper_beds(results: Path) -> pd.DataFrame:
    """Beds of parcels beside the bed itself: cost, and what each changes, in noise floors."""
    table = pd.read_csv(results / "tradeoff.csv")
    beds = table[(table["half"] == "dem") & table["axis"].isin(CHEAPER)]
    base = beds.set_index("variant").loc["base"]
    rows = {
        "bed": beds["changed"].fillna("the bed itself"),
        "cost": (beds["cost_s"] / base["cost_s"]).map(number),
    }
    for name, title in CHANGES.items():
        rows[title] = beds[f"{name}_floors_1"].map(number)
    return pd.DataFrame(rows)


def scores(results: Path) -> pd.DataFrame:
    """Errors of the chosen chains in the repeats, which nothing was learned from, and the DEM's spread."""
    table = pd.read_csv(results / "scores.csv")
    table = table.astype({"options": object}).fillna(
        {"options": "", "cell_m": 0.0, "lag_s": 0.0}
    )  # the DEM has none
    whole = table[table["time_s"].isna() & (table["window"] == "repeats")]
    wide = whole.pivot_table(index=CHAIN, columns="quantity", values="value", sort=False)
    rows = []
    for (model, cell_m, lag_s, options), values in wide.iterrows():
        kind = "spread" if model == "dem" else "error_rms"
        named = [options] if options else []
        chain = [f"{100 * cell_m:.3g} cm", f"{lag_s:g} s", *named] if model != "dem" else ["noise floor"]
        pair = {side: values.get(f"{kind}_{side}", np.nan) for side in ("radial", "axial")}
        rows.append({"chain": f"{model}: {', '.join(chain)}", "left and right": number(pair["radial"]),
                     "low and up": number(pair["axial"])})  # fmt: skip
    return pd.DataFrame(rows)


def validation(results: Path) -> pd.DataFrame:
    """Differences from measured profiles, of the simulated bed with its band and of others; aims."""
    table = pd.read_csv(results / "validation_metrics.csv")
    kept = pd.DataFrame({"quantity": table["quantity"].str.replace("_", " "), "of": table["source"]})
    low, high = (table[end].map(number) for end in ("ci_low", "ci_high"))
    band = np.where(table["ci_low"].notna(), low + " to " + high, "")
    numbers = {"value": table["value"].map(number), "95 % band": band, "aim": table["aim"].map(number)}
    return kept.assign(unit=table["unit"], **numbers, met=table["met"].fillna("")).astype(str)


def verification(results: Path) -> pd.DataFrame:
    """The solvers against theory; the error is that of the value's own average, where it is one."""
    table = pd.read_csv(results / "verification.csv")
    kept = table[["quantity"]].copy()
    digits = {"value": 4, "error": 2, "reference": 4, "tolerance": 4}
    for name, count in digits.items():
        kept[name] = [f"{value:.{count}g}" if np.isfinite(value) else "" for value in table[name]]
    return kept.assign(passed=table["pass"], source_of_reference=table["source"]).rename(
        columns={"source_of_reference": "reference from"}
    )


def peers(results: Path) -> pd.DataFrame:
    """Times of other codes on the same beds."""
    table = pd.read_csv(results / "peers.csv")
    low, high = (table[f"{end}_s_per_simulated_s"].map(number) for end in ("fastest", "slowest"))
    return pd.DataFrame(
        {
            "bed": table["bed"],
            "code": table["code"],
            "wall s a simulated s": table["wall_s_per_simulated_s"].map(number),
            "range": [f"{start} to {end}" for start, end in zip(low, high, strict=True)],
            "times bedFoam's": table["relative_to_bedfoam_1"].map(number),
            "pressure drop over weight": table["pressure_drop_per_weight_1"].map(number),
            "mean height": [f"{1e3 * height:.1f} mm" for height in table["mean_height_m"]],
            "simulated": [f"{1e3 * span:.3g} ms" for span in table["simulated_s"]],
            "differs by": table["differences"].fillna(""),
        }
    )


def stability(results: Path) -> pd.DataFrame:
    """How the settings end, with their guards on and with one off."""
    table = pd.read_csv(results / "stability.csv")
    table["guards"] = table["guards"].where(table["guards"] == "on", "one off")
    counted = table.pivot_table(index="outcome", columns="guards", aggfunc="size", fill_value=0)
    counted = counted.reindex(columns=["on", "one off"], fill_value=0)
    counted.columns = pd.Index(["guards on", "a guard off"])
    return counted.reset_index().astype(str)


def benchmark(results: Path) -> pd.DataFrame:
    """Time and memory of the Markov core."""
    table = pd.read_csv(results / "benchmark_core.csv", keep_default_na=False)
    return pd.DataFrame(
        {
            "work": table["work"],
            "method": table["method"],
            "particles": [f"{count:,}" for count in table["particles"]],
            "cells": [
                f"{columns} x {rows}" for columns, rows in zip(table["columns"], table["rows"], strict=True)
            ],
            "median": [f"{number(seconds)} s" for seconds in table["median_s"]],
            "processor": [f"{number(seconds)} s" for seconds in table["cpu_s"]],
            "peak memory": [f"{memory:.0f} MB" for memory in table["peak_rss_mb"]],
            "entries": [f"{count:,}" for count in table["entries"]],
            "target": table["target"],
            "met": table["met"],
        }
    )


def coverage(results: Path) -> pd.DataFrame:
    """How often the error bars hold the truth."""
    table = pd.read_csv(results / "coverage.csv")
    return pd.DataFrame(
        {
            "estimated": table["process"],
            "correlation times": table["correlation_times_1"].map(lambda times: f"{times:.3g}"),
            "held": [f"{100 * share:.1f} %" for share in table["covered_1"]],
            "bands": [f"{number:,}" for number in table["samples_1"]],
            "windows": [f"{number:,}" for number in table["windows_1"]],
        }
    )


def _chains(results: Path) -> pd.DataFrame:
    table = pd.read_csv(results / "tradeoff.csv", dtype={"problem": str, "preset": str})
    return table[(table["half"] == "mcm") & table["problem"].isna()].copy()


def _by_cell_and_lag(results: Path, column: str) -> pd.DataFrame:
    table = _chains(results)
    table = table[table["axis"] == CELLS_AND_LAGS]
    size = np.sqrt(table["cell_width_m"] * table["cell_height_m"]).map(lambda value: float(f"{value:.2g}"))
    return by_cell_and_lag(table.assign(cell_m=size).set_index(["cell_m", "lag_s"])[column].sort_index())


def _cell(row: dict[str, float]) -> str:
    return f"{100 * np.sqrt(row['cell_width_m'] * row['cell_height_m']):.2g} cm"
