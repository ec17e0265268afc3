# SPDX-License-Identifier: GPL-3.0-or-later
"""Actual cost of the stages of a case and actual errors of its chains, beside the estimate."""

import math
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from bedchain.case.schema import Case
from bedchain.dem.repeats import repeats_at_once
from bedchain.measures.mixing import GROUPS
from bedchain.meter import BYTES_IN_MB
from bedchain.provenance import rule_times
from bedchain.studies.cost.estimate import PREDICTED, Numbers
from bedchain.studies.cost.machine_speed import SOLVERS, simulated_here

FACTOR_AIM = 1.5  # ratio to the estimate within which an actual time should be
TOTAL = "total"
HAPPENED = [f"happened_{name}" for name in PREDICTED]


def actual_cost(case: Case, bed: Path, chains: Path, benchmarks: Mapping[str, Path]) -> pd.DataFrame:
    """Actual cost of the stages that have run here, and errors of the chains.

    Parameters
    ----------
    case : dict
        A checked case.
    bed, chains : Path
        ``results/<case>`` with its dem.json, and the folder of the chains (without a preset the same).
    benchmarks : mapping of str to Path
        Snakemake's benchmark folders of the two, by ``bed`` and ``made`` (the chains).

    Returns
    -------
    DataFrame
        Indexed by stage: happened_wall_s, happened_memory_mb, happened_disk_mb, happened_error_floors, and
        done_1, the share of the work of the stage that was done.
    """
    times = {name: _of_jobs(folder) for name, folder in benchmarks.items()}
    rows = _solver_stages(case, bed, times["bed"])
    for name, file in (("parse_dumps", bed / "trajectory.npy"), ("assign_cells", chains / "cells.npz")):
        if job := times["bed" if name == "parse_dumps" else "made"].get(name):
            rows[name] = job | {"disk_mb": _size_mb([file])}
    if "parse_dumps" in rows:  # the jobs of repeats have their own folders
        others = [rule_times(folder) for folder in sorted((benchmarks["bed"] / "repeats").glob("*"))]
        rows["parse_dumps"]["wall_s"] += sum(
            jobs["parse_dumps"]["wall_s"] for jobs in others if "parse_dumps" in jobs
        )
        rows["parse_dumps"]["disk_mb"] += _size_mb(bed.glob("repeats/*/trajectory.npy"))
    for model in case["chain"]["models"]:
        rows |= {job: times["made"][job] for job in (f"build_transitions_{model}",) if job in times["made"]}
        errors = actual_error(chains / "metrics.csv", model)
        if run := times["made"].get(f"run_chain_{model}", {} if math.isnan(errors) else {"wall_s": math.nan}):
            rows[f"run_chain_{model}"] = run | {"error_floors": errors}
    table = pd.DataFrame.from_dict(rows, orient="index").reindex(columns=[*PREDICTED, "done_1"])
    table["done_1"] = table["done_1"].fillna(1.0)
    return table.rename(columns=dict(zip(PREDICTED, HAPPENED, strict=True)))


def _solver_stages(case: Case, bed: Path, times: Mapping[str, Numbers]) -> dict[str, Numbers]:
    manifest = simulated_here(bed / "dem.json")
    if manifest is None:
        return {}
    segments, rows = manifest["segments"], {}
    state = bed / Path(segments[0]["folder"]).parent
    if (settled := settling_loop(state / "settled" / "liggghts.log")) is not None:
        rows["settling"] = {"wall_s": settled, "done_1": 1.0}
    done = segments[-1]["end_s"] / case["time"]["end_s"]
    for name in SOLVERS if case["gas"]["model"] != "none" else SOLVERS[:1]:
        rows[name] = {"wall_s": sum(segment[f"{name}_s"] for segment in segments), "done_1": done}
    rows["dem"] |= {"disk_mb": _size_mb(state.rglob("*")), **_memory_of(times, "run_dem")}
    repeats = [simulated_here(file) for file in sorted(bed.glob("repeats/*/dem.json"))]
    # of each segment: its share of the cores, since repeats run side by side
    parts = [
        segment | {"share": 1 / repeats_at_once(repeat["ranks"], case["comparison"]["repeats"])}
        for repeat in repeats
        if repeat
        for segment in repeat["segments"]
    ]
    window_s = case["comparison"]["end_s"] - case["comparison"]["start_s"]
    if parts and (wanted := case["comparison"]["repeats"]):
        spans = sum(part["end_s"] - part["start_s"] for part in parts)
        rows["repeats"] = {
            "wall_s": sum(part["wall_s"] * part["share"] for part in parts),
            "disk_mb": _size_mb(bed.glob("repeats/*/dem/**/*")),
            "done_1": spans / (wanted * window_s),
            **_memory_of(times, "repeat_dem_1"),
        }
    return rows


def settling_loop(log: Path) -> float | None:
    """Wall time of LIGGGHTS's loop in a log [s]; None without one."""
    try:
        words = [line.split() for line in log.read_text(encoding="utf-8", errors="replace").splitlines()]
        return float(next(line[3] for line in words if line[:3] == ["Loop", "time", "of"]))
    except (OSError, StopIteration, ValueError, IndexError):
        return None


def actual_error(metrics: Path, model: str) -> float:
    """Rms error of a chain's four mixing curves over their noise floor [1]; NaN where either is missing."""
    if not metrics.exists():
        return math.nan
    table = pd.read_csv(metrics).set_index(["quantity", "source"])["value"]
    pairs = [((f"error_rms_{group}", model), (f"noise_floor_{group}", "dem")) for _, group in GROUPS]
    if not all(key in table.index for pair in pairs for key in pair):
        return math.nan
    errors, floors = (np.array([table[key] for key in keys]) for keys in zip(*pairs, strict=True))
    return float(np.sqrt((errors**2).mean() / (floors**2).mean()))


def beside_actual(expected: pd.DataFrame, actual: pd.DataFrame) -> pd.DataFrame:
    """Estimate and actual cost side by side, with their ratio and a row for the total.

    Parameters
    ----------
    expected, actual : DataFrame
        Of `predicted` and `actual_cost`.

    Returns
    -------
    DataFrame
        Indexed by stage, with ratio_1: actual wall time over that expected for the part done.
    """
    table = expected.join(actual)
    part = table["wall_s"] * table["done_1"]
    table["ratio_1"] = table["happened_wall_s"] / part.where(part > 0)
    known = table["ratio_1"].notna()
    total = {
        "wall_s": table["wall_s"].sum(),
        "memory_mb": table["memory_mb"].max(),
        "disk_mb": table["disk_mb"].sum(),
    }
    if known.any():
        total |= {
            "happened_wall_s": table["happened_wall_s"][known].sum(),
            "happened_memory_mb": table["happened_memory_mb"].max(),
            "happened_disk_mb": table["happened_disk_mb"].sum(),
            "done_1": part[known].sum() / table["wall_s"].sum(),
            "ratio_1": table["happened_wall_s"][known].sum() / part[known].sum(),
        }
    table.loc[TOTAL] = pd.Series(total)
    return table.rename_axis("stage")


def far_from_estimate(table: pd.DataFrame) -> list[str]:
    """Stages whose actual wall time differs from the estimate by more than `FACTOR_AIM`."""
    ratios = table["ratio_1"].dropna()
    return list(ratios.index[(ratios > FACTOR_AIM) | (ratios < 1 / FACTOR_AIM)])


def _of_jobs(folder: Path) -> dict[str, Numbers]:
    return {
        job: {"wall_s": cost["wall_s"], "memory_mb": cost.get("peak_rss_mb", math.nan)}
        for job, cost in rule_times(folder).items()
    }


def _memory_of(times: Mapping[str, Numbers], job: str) -> Numbers:
    return {"memory_mb": times[job]["memory_mb"]} if job in times else {}


def _size_mb(files: Iterable[Path]) -> float:
    return sum(file.stat().st_size for file in files if file.is_file()) / BYTES_IN_MB
