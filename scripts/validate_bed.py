# SPDX-License-Identifier: GPL-3.0-or-later
"""The simulated bed against measured profiles: validation.csv, validation_metrics.csv and a figure."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt

from bedchain.figures.style import DOUBLE_COLUMN_IN, LINE_COLOUR, FigureFiles, figure_style
from bedchain.files import write_csv
from bedchain.measures.voidage import Slab
from bedchain.stage import LOG, run_stage
from bedchain.studies.validation import BedFrames, compare, measurement_metrics, read_points, simulated
from bedchain.trajectory.frames import Window
from bedchain.trajectory.store import BedFiles

AIMS = {"voidage_error_rms": 0.05, "particle_velocity_error_rms": 0.04}
FINE_POINTS = 81  # of the drawn curve
LABELS = {"voidage_1": "voidage [1]", "particle_velocity_m_s": "particle velocity [m/s]"}
SIMULATED = "#0077bb"
PANEL_IN, LEGEND_IN = 1.9, 0.3


@dataclass(frozen=True)
class Published:
    """What was published of the bed.

    Attributes
    ----------
    points : Path
        Measured points, ``cases/<case>/measured.csv``.
    peers : list of Path
        Simulations, ``cases/<case>/peers.csv`` where there is one: quantity, source, value, unit, reference.
    """

    points: Path
    peers: list[Path]


def draw(table: pd.DataFrame, curves: pd.DataFrame, files: FigureFiles) -> None:
    """A row of panels for each quantity, one for each height: measured points, simulated curve and band."""
    rows = [list(points.groupby("height_m")) for _, points in table.groupby("quantity", sort=False)]
    size = DOUBLE_COLUMN_IN, PANEL_IN * len(rows) + LEGEND_IN
    with figure_style():
        figure, axes = plt.subplots(len(rows), max(map(len, rows)), squeeze=False, figsize=size)
        for panels, heights in zip(axes, rows, strict=True):
            for axis in panels[len(heights) :]:
                axis.set_visible(False)
            for axis, (height, points) in zip(panels, heights, strict=False):
                quantity = points["quantity"].iloc[0]
                curve = curves[(curves["quantity"] == quantity) & (curves["height_m"] == height)]
                x, low, high = 1e3 * curve["position_x_m"], curve["ci_low"], curve["ci_high"]
                axis.fill_between(x, low, high, color=SIMULATED, alpha=0.25, linewidth=0, label="95 % band")
                axis.plot(x, curve["simulated"], color=SIMULATED, label="simulated")
                style = {"color": LINE_COLOUR, "markersize": 3, "markerfacecolor": "none"}
                axis.plot(1e3 * points["position_x_m"], points["measured"], "o", label="measured", **style)
                axis.set(xlabel="x [mm]", ylabel=LABELS[quantity], title=f"z = {1e3 * height:g} mm")
            for axis in panels[1:]:
                axis.sharey(panels[0])
        figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
        files.save(figure)


def validate_bed(
    bed: BedFiles, published: Published, table: Path, metrics: Path, files: FigureFiles,
    window: Window, width_m: float, slab: Slab,
) -> None:  # fmt: skip
    """Average the bed over a window as the measurement does, and put both side by side.

    Parameters
    ----------
    bed : BedFiles
    published : Published
    table, metrics : Path
        Get every point, and the differences with their aims, those of the peers, and how far the measurement
        is from its own mirror image.
    files : FigureFiles
        Figure, and its curves.
    window : Window
        To average over.
    width_m : float
        Of the bed [m].
    slab : Slab
    """
    measured = read_points(published.points)
    store, described = bed.open()
    frames = store[window.frames(np.array(described["times_s"]))]
    seen = BedFrames(frames, described["frame_interval_s"], slab.diameter_m / 2, width_m, slab.thickness_m)
    compared, differences = compare(measured, seen)
    others = [pd.read_csv(file, comment="#") for file in published.peers]
    rows = pd.concat([differences, *others, measurement_metrics(measured, width_m)], ignore_index=True)
    rows["aim"] = rows["quantity"].map(AIMS)
    rows["met"] = np.where(rows["aim"].isna(), "", np.where(rows["value"] <= rows["aim"], "yes", "no"))
    x = np.linspace(0, width_m, FINE_POINTS)
    panels = measured[["quantity", "height_m"]].drop_duplicates().itertuples(index=False)
    curves = pd.concat([simulated(seen, quantity, height, x)[0] for quantity, height in panels])
    draw(compared, curves, files)
    write_csv(curves, files.csv)
    write_csv(compared, table)
    write_csv(rows, metrics)
    for row in rows[rows["aim"].notna()].itertuples():
        LOG.info(
            "%s of %s: %.4g %s (95 %% band %.3g to %.3g), aim %.4g: %s", row.quantity, row.source, row.value,
            row.unit, row.ci_low, row.ci_high, row.aim, "met" if row.met == "yes" else "missed",
        )  # fmt: skip


if rule := globals().get("snakemake"):
    run_stage(validate_bed, rule)
