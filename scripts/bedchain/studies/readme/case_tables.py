# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of one case for its README: the bed, errors of the chains, costs, and the paper's claims.

Each function takes ``results/<case>`` and gives texts as they are shown.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from bedchain.comparison.claims import cost_metrics
from bedchain.measures.mixing import GROUPS

PARTS = [name for _, name in GROUPS]
MONTE_CARLO = "_monte_carlo"
CHOSEN = "chosen"
LONGER_LAG_S = 0.1  # that mends what the velocity forgotten at 0.025 s does
ANOTHER_RUN = np.sqrt(2)  # rms difference of two realisations over the noise floor


def number(value: float) -> str:
    """Three significant digits; large numbers in full, nothing for NaN."""
    if not np.isfinite(value):
        return ""
    return f"{value:.0f}" if 1000 <= abs(value) < 1e6 else f"{value:.3g}"


def summary(results: Path) -> pd.DataFrame:
    """The numbers of the README at the door, for a case with the paper's claims and repeats."""
    claimed = pd.read_csv(results / "agreement.csv").set_index(["quantity", "source"])
    value = pd.read_csv(results / "metrics.csv").set_index(["quantity", "source"])["value"]
    low = f"{100 * value['share_mean_low', 'dem']:.0f} %"
    rows = [("particles below 0.25 m, mean over 15 to 20 s", "65 % (at 15 s)", low)]
    rows += _errors_over_another_run(results, value["realisations", "dem"])
    rows += _error_of_choice(results, value)
    hours = claimed.loc[("dem_time", "dem")]
    rows.append(("5 s of DEM and gas", f"{hours['paper']:.0f} h", f"{hours['ours']:.2g} h"))
    for quantity, chain, words in (
        ("dem_over_chain_time", "static", "DEM over static chain, in time"),
        ("dynamic_over_static_time", "dynamic", "dynamic over static matrix, in time"),
    ):
        row = claimed.loc[(quantity, chain)]
        rows.append((words, number(row["paper"]), number(row["ours"])))
    return pd.DataFrame(rows, columns=["quantity", "paper", "here"])


def _errors_over_another_run(results: Path, realisations: float) -> list[tuple[str, str, str]]:
    """Rows of the chains' errors from the mean of the realisations, over those of a further DEM run."""
    case = _case(results)
    bed, cells, lag_s = case["bed"], case["cells"], case["chain"]["lag_s"]
    cell_m = np.sqrt(bed["width_m"] * bed["height_m"] / (cells["columns"] * cells["rows"]))
    discussion = pd.read_csv(results / "discussion.csv")
    another = np.sqrt(1 + 1 / realisations)  # of a further run, in noise floors
    rows = []
    for chain, lag in (("static", lag_s), ("static", LONGER_LAG_S), ("dynamic", lag_s)):
        floors = _in_floors(discussion, chain)
        away = [abs(size_m - cell_m) + abs(at_s - lag) for size_m, at_s in floors.index]
        words = f"error of the {chain} chain over another DEM run's, lag {lag:g} s"
        rows.append((words, "", number(floors.iloc[np.argmin(away)] / another)))
    return rows


def _error_of_choice(results: Path, value: "pd.Series[Any]") -> list[tuple[str, str, str]]:
    """Row of the chosen chain, as those of the others; none where the case has none."""
    if ("error_rms_of_mean_left", CHOSEN) not in value.index:
        return []
    choice = pd.read_csv(results / "choice.csv").set_index("quantity")["value"].astype(float)
    error, floor = (
        np.mean([value[f"{name}_{part}", source] ** 2 for part in PARTS])
        for name, source in (("error_rms_of_mean", CHOSEN), ("noise_floor", "dem"))
    )
    another = 1 + 1 / value["realisations", "dem"]
    lag_s, cell_cm = choice["lag_s"], 100 * choice["cell_m"]
    words = f"error of the chosen chain over another DEM run's, lag {lag_s:g} s, cells of {cell_cm:.3g} cm"
    return [(words, "", number(np.sqrt(error / floor / another)))]


def errors(results: Path) -> pd.DataFrame:
    """Errors of each chain's mixing curves, beside what another DEM run has."""
    metrics = pd.read_csv(results / "metrics.csv")
    value = metrics.set_index(["quantity", "source"])["value"]
    rms = metrics[metrics["quantity"] == "error_rms_left"]["source"]
    chains = [name for name in rms if not name.endswith(MONTE_CARLO)]
    rows = []
    for chain in ["another DEM run", *chains]:
        for part in PARTS:
            floor = value.get(("noise_floor_" + part, "dem"), np.nan)
            error, of_mean, bias = (
                value.get((f"error_{name}_{part}", chain), np.nan)
                for name in ("rms", "rms_of_mean", "signed_of_mean")
            )
            error = error if chain in chains else ANOTHER_RUN * floor
            rows.append(
                {
                    "chain": chain.replace("_", " "),
                    "group": part,
                    "noise floor": number(floor),
                    "rms error against the run": number(error),
                    "over another DEM run's": number(error / (ANOTHER_RUN * floor)),
                    "rms error against the mean of all realisations": number(of_mean),
                    "mean difference from it": number(bias),
                }
            )
    return pd.DataFrame(rows)


def bed(results: Path) -> pd.DataFrame:
    """The simulated bed over the learning and comparison windows, and the time that it took."""
    case = _case(results)
    dem = json.loads((results / "dem.json").read_text(encoding="utf-8"))
    series = pd.read_csv(results / "bed_series.csv")
    start_s, end_s = case["learning"]["start_s"], case["comparison"]["end_s"]
    inside = series[series["time_s"].between(start_s, end_s)]
    mean, largest = inside.mean(numeric_only=True), inside.max(numeric_only=True)
    times = pd.DataFrame(dem["segments"])
    spans = times["end_s"] - times["start_s"]
    solver = times[["dem_s", "exchange_s", "gas_s"]].sum()
    rows = {
        "window": f"{start_s:g} to {end_s:g} s",
        "weight carried by the gas": f"{100 * mean['weight_on_gas_1']:.1f} %",
        "weight carried by the floor": f"{100 * mean['weight_on_floor_1']:.1f} %",
        "weight carried by the side walls": f"{100 * mean['weight_on_sides_1']:.1f} %",
        "mean height of the particles": f"{1e3 * mean['mean_height_m']:.1f} mm",
        "smallest voidage of a gas cell": number(inside["smallest_voidage_1"].min()),
        "times the voidage was clipped": number(inside["voidage_clips_1"].sum()),
        "deepest overlap": f"{100 * largest['largest_overlap_1']:.0f} % of a diameter",
        "largest error of the momentum exchange": number(largest["exchange_error_1"]),
        "largest error of the gas balance": number(largest["volume_balance_1"]),
        "ranks": str(dem["ranks"]),
        "wall time of the whole run": f"{times['wall_s'].sum() / 60:.0f} min",
        "wall time of a simulated second: mean": f"{times['wall_s'].sum() / spans.sum():.0f} s",
        "wall time of a simulated second: slowest segment": f"{(times['wall_s'] / spans).max():.0f} s",
        **_processor_time(times, spans),
        "gas and exchange over the particles' time": number(
            (solver["exchange_s"] + solver["gas_s"]) / solver["dem_s"]
        ),
    }
    return _listed(rows)


def _processor_time(segments: pd.DataFrame, spans: "pd.Series[float]") -> dict[str, str]:
    """Row of the processor time; none of a run by an earlier version, which has no such record."""
    if "cpu_s" not in segments or segments["cpu_s"].min() <= 0:
        return {}
    return {"processor time of a simulated second": f"{segments['cpu_s'].sum() / spans.sum():.0f} s"}


def costs(results: Path) -> pd.DataFrame:
    """Times of the comparison window by DEM and chains, and their ratios."""
    timing = pd.read_csv(results / "timing.csv")
    models = [name.removesuffix("_count") for name in timing["stage"] if name.endswith("_count")]
    rows = {"DEM and gas, comparison window": f"{timing.set_index('stage')['wall_s']['dem']:.0f} s"}
    for model in models:
        for stage, name in (
            ("count", "counts"),
            ("matrix", "matrix"),
            ("exact", "exact curves"),
            ("monte_carlo", "Monte Carlo"),
        ):
            wall_s = timing.set_index("stage")["wall_s"].get(f"{model}_{stage}", np.nan)
            rows[f"{model.replace('_', ' ')} chain: {name}"] = f"{number(1e3 * wall_s)} ms"
    for ratio in cost_metrics(timing, models)[1:]:
        words = (
            "DEM over chain" if ratio["quantity"] == "dem_over_chain_time" else "matrix over static matrix"
        )
        rows[f"{str(ratio['source']).replace('_', ' ')}: {words}"] = f"{number(ratio['value'])} times"
    return _listed(rows)


def agreement(results: Path) -> pd.DataFrame:
    """The paper's claims beside what came out."""
    table = pd.read_csv(results / "agreement.csv")
    kept = table[["claim", "paper", "ours", "unit", "within", "why"]].copy()
    for name in ("paper", "ours"):
        kept[name] = table[name].map(number)
    return kept.astype(str).rename(columns={"within": "within tolerance"})


def steadiness(results: Path) -> pd.DataFrame:
    """Drift of the bed over learning and comparison."""
    table = pd.read_csv(results / "stationarity.csv")
    whole, rows = table[table["height_m"].isna()], table[table["height_m"].notna()]
    kept = pd.DataFrame({"quantity": whole["quantity"].str.replace("_", " "), "unit": whole["unit"]})
    for name, column in (("mean", "mean"), ("drift", "drift"), ("95 % from", "ci_low"), ("to", "ci_high")):
        kept[name] = whole[column].map(number)
    drifting = int((rows["stationary_1"] == 0).sum())
    last = {"quantity": f"voidage of {len(rows)} rows of cells", "unit": "1", "mean": "",
            "drift": f"{drifting} of {len(rows)} beyond their interval",
            "95 % from": "", "to": ""}  # fmt: skip
    return pd.concat([kept, pd.DataFrame([last])], ignore_index=True).astype(str)


def cells_and_lags(results: Path) -> pd.DataFrame:
    """Error of the static chain by cell size and lag, in noise floors, from the mean of all realisations."""
    table = pd.read_csv(results / "discussion.csv")
    return by_cell_and_lag(_in_floors(table, "static").sort_index())


def _in_floors(discussion: pd.DataFrame, chain: str) -> "pd.Series[Any]":
    """Error of a chain's four curves together by cell size and lag, in the table's order [noise floors]."""
    squared = discussion.assign(value=discussion["value"] ** 2)
    floor = squared.loc[squared["quantity"] == "noise_floor", "value"].mean()
    rows = squared[(squared["quantity"] == "error_rms") & (squared["source"] == chain)]
    mean = rows.groupby(["cell_m", "lag_s"], sort=False)["value"].mean()
    return (mean / floor).map(np.sqrt)


def by_cell_and_lag(values: "pd.Series[Any]") -> pd.DataFrame:
    """Values by cell size [m] and lag [s] as a table: a row a cell size, a column a lag."""
    wide = values.unstack()
    wide.columns = pd.Index([f"lag {lag:g} s" for lag in wide.columns])
    wide = wide.map(lambda value: f"{value:.2f}" if np.isfinite(value) else "")
    wide.insert(0, "cell", [f"{100 * size:.3g} cm" for size in wide.index])
    return wide.reset_index(drop=True)


def ladder(results: Path) -> pd.DataFrame:
    """Every model of the ladder, cheapest first: its cost, its memory and its errors in noise floors."""
    table = pd.read_csv(results / "ladder.csv")
    models = table.drop_duplicates("model").set_index("model")
    errors = table.pivot_table(index="model", columns="quantity", values="error_floors")
    rows = pd.DataFrame(
        {
            "s of a core a simulated s": models["cost_s_per_s"].map(number),
            "MB": models["memory_mb"].map(number),
        }
    )
    for name in table.loc[table["error_floors"].notna(), "quantity"].unique():
        rows[name.replace("_", " ")] = errors[name].reindex(models.index).map(number)
    return rows.loc[models["cost_s_per_s"].sort_values().index].reset_index()


def _listed(rows: dict[str, str]) -> pd.DataFrame:
    return pd.DataFrame({"quantity": list(rows), "value": list(rows.values())})


def _case(results: Path) -> dict[str, Any]:
    """The case as it was run."""
    record: dict[str, Any] = json.loads((results / "provenance.json").read_text(encoding="utf-8"))
    values: dict[str, Any] = record["case"]["values"]
    return values
