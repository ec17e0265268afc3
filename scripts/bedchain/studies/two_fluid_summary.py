# SPDX-License-Identifier: GPL-3.0-or-later
"""A two-fluid run as series, profiles and mixing curves: small tables that figures and the ladder take."""

import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.case.schema import Case
from bedchain.chains.flow_chain import Fluxes, contents_of, remaining
from bedchain.comparison.curves import curve_table
from bedchain.dem.two_fluid import Run
from bedchain.dem.two_fluid_balance import COLUMNS, carried
from bedchain.dem.two_fluid_fields import Flow
from bedchain.dem.two_fluid_start import grid_of
from bedchain.errors import UserError
from bedchain.files import write_csv, write_text
from bedchain.measures.bubbles import followed_bubbles, middle_of_bed
from bedchain.measures.mixing import side_shares
from bedchain.measures.spectrum import dominant_frequency
from bedchain.provenance import case_hash, debian_packages, git_state, machine

Array = NDArray[np.float64]
BETWEEN_STARTS_S = 1.0  # mixing curves are means over starts
MOST_STARTS = 4


class Summary(NamedTuple):
    """Tables of a summary, in its folder.

    Attributes
    ----------
    series : DataFrame
        time_s, mean_height_m, share_low_1 of frames.
    pressure : DataFrame
        time_s, pressure_drop_Pa, solids_drift_1.
    profile : DataFrame
        height_m, voidage_1, a mean over the window.
    density : DataFrame
        x_m, z_m, share_1 of the solids in each cell, a mean over the window.
    balance : DataFrame
        What carries the weight, of frames (`dem.two_fluid_balance`); may be empty.
    mixing : DataFrame
        time_s after the start, source (frames, mean_flow), direction, group, fraction_remaining_1.
    record : dict
        Grid, window, cost, bubbles at half height, dominant frequency of the pressure drop, what carries the
        weight, provenance.
    """

    series: pd.DataFrame
    pressure: pd.DataFrame
    profile: pd.DataFrame
    density: pd.DataFrame
    balance: pd.DataFrame
    mixing: pd.DataFrame
    record: dict[str, Any]


def summarise(run: Run, case: Case) -> Summary:
    """Summary of a run, over the part of learning and comparison that it reached.

    Parameters
    ----------
    run : Run
    case : dict
        Of the run.

    Raises
    ------
    UserError
        It ended before the start of the learning window.
    """
    flow, bed, grid = run.flow, case["bed"], grid_of(case)
    start_s, end_s = case["learning"]["start_s"], case["comparison"]["end_s"]
    which = (flow.times_s > start_s - 1e-9) & (flow.times_s < end_s + 1e-9)
    if which.sum() < 2:
        raise UserError(
            f"the two-fluid run has reached {flow.times_s[-1]:g} s, its window starts at {start_s:g} s"
        )
    share = flow.solids / flow.solids.sum(axis=(1, 2), keepdims=True)
    seen, mean = flow.solids[which], share[which].mean(axis=0)
    x, z = grid.centres_m.T
    window_s = float(flow.times_s[which][0]), float(flow.times_s[which][-1])
    interval = float(np.diff(flow.times_s[:2])[0])
    height_m = 2 * float(mean.ravel() @ z)
    bubbles = followed_bubbles(1 - seen, grid.cell_height_m, interval, bed["width_m"])
    record = {
        "cell_m": grid.cell_height_m, "gas_step_s": case["time"]["gas_step_s"],
        "cpu_s_per_s": run.cpu_s_per_s,
        **({"memory_mb": run.memory_mb} if np.isfinite(run.memory_mb) else {}), "window_s": list(window_s),
        "largest_drift_1": float(run.series["solids_drift_1"].abs().max()),
        **middle_of_bed(*bubbles, height_m), **pressure_record(run.series, window_s, piece_of(case)),
        **weight_record(run.balance, window_s),
        "case": case_hash(case), "code": git_state(), "machine": machine(), "packages": debian_packages(),
    }  # fmt: skip
    heights = grid.centres_m[:: grid.columns, 1]
    return Summary(
        series_of(flow, share, case),
        run.series,
        pd.DataFrame({"height_m": heights, "voidage_1": 1 - seen.mean(axis=(0, 2))}),
        pd.DataFrame({"x_m": x, "z_m": z, "share_1": mean.ravel()}),
        run.balance,
        mixing_table(flow, which, case),
        record,
    )


def series_of(flow: Flow, share: Array, case: Case) -> pd.DataFrame:
    """Mean height and share below the line of all frames, from the share of the solids in each cell."""
    grid, lines = grid_of(case), case["mixing"]
    low = side_shares(grid, lines["split_x_m"], lines["split_z_m"])[2]
    cells = share.reshape(len(share), -1)
    return pd.DataFrame(
        {
            "time_s": flow.times_s,
            "mean_height_m": cells @ grid.centres_m[:, 1],
            "share_low_1": cells @ low,
        }
    )


def piece_of(case: Case) -> float:
    """Length of the pieces of a pressure drop's spectrum: a fifth of learning and comparison [s]."""
    return float(sum(case[name]["end_s"] - case[name]["start_s"] for name in ("learning", "comparison")) / 5)


def pressure_record(series: pd.DataFrame, window_s: tuple[float, float], piece_s: float) -> dict[str, float]:
    """Mean, scatter and dominant frequency of a pressure drop over a window."""
    within = series[series["time_s"].between(*window_s)]
    peak = dominant_frequency(within["time_s"], within["pressure_drop_Pa"], piece_s)
    return {
        "pressure_drop_Pa": float(within["pressure_drop_Pa"].mean()),
        "pressure_drop_std_Pa": float(within["pressure_drop_Pa"].std()),
        "pressure_frequency_Hz": peak.frequency_hz,
        "pressure_frequency_resolution_Hz": peak.resolution_hz,
    }


def weight_record(balance: pd.DataFrame, window_s: tuple[float, float]) -> dict[str, dict[str, float]]:
    """What carries the weight over a window; nothing where the run did not keep it."""
    within = balance[balance["time_s"].between(*window_s)]
    return {"carries_weight_1": carried(within)} if len(within) > 1 else {}


def mixing_table(flow: Flow, which: NDArray[np.bool_], case: Case) -> pd.DataFrame:
    """Mixing curves of the chain of each frame in order, and of the chain of their mean flow.

    A curve is a mean over starts `BETWEEN_STARTS_S` apart, and as long as the comparison or the run allows.
    """
    grid, bed, lines = grid_of(case), case["bed"], case["mixing"]
    interval = float(np.diff(flow.times_s[:2])[0])
    volume = grid.cell_width_m * grid.cell_height_m * bed["thickness_m"]
    contents = contents_of(flow.solids, volume)
    sides = side_shares(grid, lines["split_x_m"], lines["split_z_m"])
    frames = np.flatnonzero(which)
    length = min(
        round((case["comparison"]["end_s"] - case["comparison"]["start_s"]) / interval), len(frames) // 2
    )
    spacing = round(BETWEEN_STARTS_S / interval)
    starts = list(range(frames[0], frames[-1] - length + 1, spacing))[-MOST_STARTS:]

    def of_frames(start: int) -> Array:
        def step(at: int) -> Fluxes:
            end = start + at + 1
            return Fluxes(contents[end - 1], contents[end], flow.right[end], flow.up[end])

        return remaining(contents[start], step, length, interval, sides)

    steady = contents[frames].mean(axis=0)
    mean = Fluxes(steady, steady, flow.right[frames].mean(axis=0), flow.up[frames].mean(axis=0))
    curves = {
        "frames": np.mean([of_frames(start) for start in starts], axis=0),
        "mean_flow": remaining(steady, lambda _: mean, length, interval, sides),
    }  # fmt: skip
    times = interval * np.arange(length + 1)
    rows = [curve_table(times, source, values) for source, values in curves.items()]
    return pd.concat(rows, ignore_index=True)


def write_summary(summary: Summary, folder: Path) -> None:
    """Write a summary as csv files and ``record.json``."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, table in summary._asdict().items():
        if name != "record":
            write_csv(table, folder / f"{name}.csv")
    write_text(folder / "record.json", json.dumps(summary.record, indent=1) + "\n")


def read_summary(folder: Path) -> Summary:
    """Summary written by `write_summary`; an older one has no balance."""
    tables = {
        name: pd.read_csv(folder / f"{name}.csv")
        for name in Summary._fields
        if name not in ("record", "balance")
    }
    file = folder / "balance.csv"
    balance = pd.read_csv(file) if file.exists() else pd.DataFrame(columns=COLUMNS)
    record = json.loads((folder / "record.json").read_text(encoding="utf-8"))
    return Summary(**tables, balance=balance, record=record)
