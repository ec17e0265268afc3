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
from bedchain.dem.two_fluid import grid_of
from bedchain.dem.two_fluid_fields import Flow
from bedchain.errors import UserError
from bedchain.files import write_csv, write_text
from bedchain.measures.bubbles import followed_bubbles, middle_of_bed
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
    mixing : DataFrame
        time_s after the start, source (frames, mean_flow), direction, group, fraction_remaining_1.
    record : dict
        Grid, window, cost, bubbles at half height, provenance.
    """

    series: pd.DataFrame
    pressure: pd.DataFrame
    profile: pd.DataFrame
    density: pd.DataFrame
    mixing: pd.DataFrame
    record: dict[str, Any]


def summarise(flow: Flow, pressure: pd.DataFrame, cpu_s_per_s: float, case: Case) -> Summary:
    """Summary of a run, over the part of learning and comparison that it reached.

    Parameters
    ----------
    flow, pressure, cpu_s_per_s
        Of `dem.two_fluid.read_flow`.
    case : dict
        Of the run.

    Raises
    ------
    UserError
        It ended before the start of the learning window.
    """
    grid, bed, line = grid_of(case), case["bed"], case["mixing"]["split_z_m"]
    start_s, end_s = case["learning"]["start_s"], case["comparison"]["end_s"]
    which = (flow.times_s > start_s - 1e-9) & (flow.times_s < end_s + 1e-9)
    if which.sum() < 2:
        raise UserError(
            f"the two-fluid run has reached {flow.times_s[-1]:g} s, its window starts at {start_s:g} s"
        )
    z, x = (grid.cell_m * (np.arange(n) + 0.5) for n in (grid.nz, grid.nx))
    share = flow.solids / flow.solids.sum(axis=(1, 2), keepdims=True)
    low = share_of_side(grid.nz, grid.cell_m, line)
    series = pd.DataFrame(
        {
            "time_s": flow.times_s,
            "mean_height_m": (share.sum(axis=2) * z).sum(axis=1),
            "share_low_1": (share.sum(axis=2) * low).sum(axis=1),
        }
    )
    seen, mean = flow.solids[which], share[which].mean(axis=0)
    interval = float(np.diff(flow.times_s[:2])[0])
    height_m = 2 * float(mean.sum(axis=1) @ z)
    record = {
        "cell_m": grid.cell_m, "gas_step_s": case["time"]["gas_step_s"], "cpu_s_per_s": cpu_s_per_s,
        "window_s": [float(flow.times_s[which][0]), float(flow.times_s[which][-1])],
        "largest_drift_1": float(pressure["solids_drift_1"].abs().max()),
        **middle_of_bed(*followed_bubbles(1 - seen, grid.cell_m, interval, bed["width_m"]), height_m),
        "case": case_hash(case), "code": git_state(), "machine": machine(), "packages": debian_packages(),
    }  # fmt: skip
    return Summary(
        series,
        pressure,
        pd.DataFrame({"height_m": z, "voidage_1": 1 - seen.mean(axis=(0, 2))}),
        pd.DataFrame({"x_m": np.tile(x, grid.nz), "z_m": np.repeat(z, grid.nx), "share_1": mean.ravel()}),
        mixing_table(flow, which, case),
        record,
    )


def share_of_side(cells: int, cell_m: float, line_m: float) -> Array:
    """Share of each of a row of cells that lies before a line [1]."""
    return np.clip(line_m / cell_m - np.arange(cells), 0, 1)


def mixing_table(flow: Flow, which: NDArray[np.bool_], case: Case) -> pd.DataFrame:
    """Mixing curves of the chain of each frame in order, and of the chain of their mean flow.

    A curve is a mean over starts `BETWEEN_STARTS_S` apart, and as long as the comparison or the run allows.
    """
    grid, bed, lines = grid_of(case), case["bed"], case["mixing"]
    interval = float(np.diff(flow.times_s[:2])[0])
    volume = grid.cell_m**2 * bed["thickness_m"]
    contents = contents_of(flow.solids, volume)
    left = np.tile(share_of_side(grid.nx, grid.cell_m, lines["split_x_m"]), grid.nz)
    low = np.repeat(share_of_side(grid.nz, grid.cell_m, lines["split_z_m"]), grid.nx)
    sides = np.array([left, 1 - left, low, 1 - low])
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
    """Summary written by `write_summary`."""
    tables = {name: pd.read_csv(folder / f"{name}.csv") for name in Summary._fields if name != "record"}
    return Summary(**tables, record=json.loads((folder / "record.json").read_text(encoding="utf-8")))
