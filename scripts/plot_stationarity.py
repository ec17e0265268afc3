# SPDX-License-Identifier: GPL-3.0-or-later
"""Drifts of the bed over learning and comparison, with their intervals: stationarity.csv and a figure."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

from bedchain.dem.series import read_series
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style, footnote
from bedchain.files import write_csv
from bedchain.measures.mixing import Splits
from bedchain.measures.voidage import Slab, voidage_profiles
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.frames import Window
from bedchain.trajectory.store import BedFiles
from bedchain.uncertainty.stationarity import drift_table

TITLES = {
    "pressure_drop": "pressure drop [Pa]",
    "surface_angle": "inclination of the surface [rad]",
    "particle_height": "mean particle height [m]",
    "share_left": "share in the left half [1]",
    "share_low": "share in the lower part [1]",
}
LINE_COLOUR, HALF_COLOURS = "#222222", ("#4477aa", "#ee6677")
TREND_COLOUR = "#ee6677"
# a drift is given to this, since round-off of a constant is no measurement [%]
SMALLEST_PERCENT = 0.01
NOTE = """Red: straight line through the series; its change over the window, with a 95 % interval, is the
drift, in percent of the mean. Rows of voidage: one interval for all of them together. Squares, if any: rows
that drift."""


def plot_stationarity(
    bed_series: Path, bed: BedFiles, stationarity: Path, files: FigureFiles,
    window: Window, splits: Splits, row_m: float, slab: Slab,
) -> None:  # fmt: skip
    """Judge pressure drop (a drum's inclination), height, shares of both sides and voidage by height.

    Parameters
    ----------
    bed_series : Path
        ``bed_series.csv``.
    bed : BedFiles
    stationarity : Path
        Table of drifts to make.
    files : FigureFiles
        Figure in two forms, and the series behind it.
    window : Window
        From the start of the learning to the end of the comparison.
    splits : Splits
    row_m : float
        Height of a row of the voidage profile [m].
    slab : Slab
    """
    series = read_series(bed_series)
    series = series[series["time_s"].between(window.start_s, window.end_s)]
    step_s = float(series["time_s"].diff().median())
    store, described = bed.open()
    frames = window.frames(np.array(described["times_s"]))
    rows = round(described["height_m"] / row_m)
    edges = np.linspace(0, described["height_m"], rows + 1)
    profile = voidage_profiles(store[frames, 1], edges, described["width_m"], slab)
    interval_s = described["frame_interval_s"]
    of_solvers = [("pressure_drop", "Pa"), ("surface_angle", "rad")]
    seen = {
        name: (unit, step_s, series[f"{name}_{unit}"].to_numpy())
        for name, unit in of_solvers
        if f"{name}_{unit}" in series
    } | {
        "particle_height": ("m", step_s, series["mean_height_m"].to_numpy()),
        "share_left": ("1", interval_s, (store[frames, 0] < splits.split_x_m).mean(axis=1)),
        "share_low": ("1", interval_s, (store[frames, 1] < splits.split_z_m).mean(axis=1)),
    }
    middles = (edges[1:] + edges[:-1]) / 2
    table = drift_table(seen, profile, middles, interval_s)
    shown = pd.concat(
        [
            pd.DataFrame(
                {"quantity": name, "time_s": window.start_s + step * np.arange(len(values)), "value": values}
            )
            for name, (_, step, values) in seen.items()
        ]
    )
    with figure_style():
        figure = plt.figure(figsize=(DOUBLE_COLUMN_IN, 3.8))
        grid = figure.add_gridspec(2, 3, width_ratios=(1, 1, 0.9))
        for at, name in enumerate(seen):
            axes = figure.add_subplot(grid[at // 2, at % 2])
            _draw_series(axes, shown[shown["quantity"] == name], table, name)
            if at >= len(seen) - 2:  # nothing is below it
                axes.set_xlabel("time [s]")
        _draw_profile(figure.add_subplot(grid[:, 2]), profile, middles, table)
        footnote(figure, NOTE)
        files.save(figure)
    write_csv(table, stationarity)
    write_csv(shown, files.csv)
    drifting = table[table["stationary_1"] == 0]
    LOG.info(
        "%d of %d drifts are more than chance: %s", len(drifting), len(table), ", ".join(drifting["quantity"])
    )


def _draw_series(axes: Axes, series: pd.DataFrame, table: pd.DataFrame, name: str) -> None:
    """A series with the straight line through it; the title says what its interval allows."""
    row = table[table["quantity"] == name].iloc[0]
    ends = series["time_s"].iloc[[0, -1]]
    axes.plot(series["time_s"], series["value"], color=LINE_COLOUR, lw=0.6)
    line = [row["mean"] - row["drift"] / 2, row["mean"] + row["drift"] / 2]
    axes.plot(ends, line, color=TREND_COLOUR, lw=1.6)
    axes.set_title(f"{TITLES[name]}\n{verdict(row)}", loc="left")
    axes.set_xlim(*ends)


def verdict(row: pd.Series) -> str:
    """What the interval of a drift says, as shares of the mean."""
    ends = [100 * row[key] / abs(row["mean"]) for key in ("ci_low", "ci_high")]
    if not np.isfinite(ends).all():
        return "drift unknown: window too short"
    if row["stationary_1"]:
        return f"no drift seen, at most {max(SMALLEST_PERCENT, *map(abs, ends)):.2g} %"
    return f"drifts by {ends[0]:+.2g} to {ends[1]:+.2g} %"


def _draw_profile(axes: Axes, profile: np.ndarray, middles: np.ndarray, table: pd.DataFrame) -> None:
    """Voidage by height in both halves of the span; rows that drift are marked."""
    rows = table[table["quantity"] == "voidage"]
    # the row above them is shown, so that no curve ends at the frame
    row_m = float(middles[1] - middles[0]) if len(middles) > 1 else 0.0
    half = len(profile) // 2
    for part, name, colour, style in zip(
        (profile[:half], profile[half:]),
        ("first half", "second half"),
        HALF_COLOURS,
        ("-", (0, (4, 1.5))),
        strict=True,
    ):
        axes.plot(part.mean(axis=0), middles, color=colour, linestyle=style, label=name)
    off = rows[rows["stationary_1"] == 0]
    if len(off):
        axes.plot(
            off["mean"], off["height_m"], "s", ms=3, mfc="none", color=LINE_COLOUR, label="row that drifts"
        )
    axes.set(xlabel="voidage [1]", ylabel="z [m]", ylim=(0, float(rows["height_m"].max()) + row_m))
    unknown = int(rows["ci_low"].isna().sum())
    named = f"drift seen in {len(off) or 'none'} of {len(rows) - unknown} rows"
    axes.set_title(
        f"voidage by height\n{named if unknown < len(rows) else 'drift unknown: window too short'}",
        loc="left",
    )
    axes.legend(loc="best")


if rule := globals().get("snakemake"):
    run_stage(plot_stationarity, rule)
