# SPDX-License-Identifier: GPL-3.0-or-later
"""The simulated bed against measured profiles: validation.csv, validation_metrics.csv and a figure."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt

from bedchain.figures import DOUBLE_COLUMN_IN, LINE_COLOUR, figure_style, save_figure
from bedchain.frames import window
from bedchain.stage import LOG, stage, write_csv
from bedchain.trajectory import open_trajectory
from bedchain.validation import Bed, compare, read_points, simulated

AIMS = {"voidage_error_rms": 0.05, "particle_velocity_error_rms": 0.04}
FINE_POINTS = 81  # of the drawn curve
LABELS = {"voidage_1": "voidage [1]", "particle_velocity_m_s": "particle velocity [m/s]"}
SIMULATED = "#0077bb"
PANEL_IN = 1.9


def draw(table: pd.DataFrame, curves: pd.DataFrame, png: Path, pdf: Path, resolution_dpi: int) -> None:
    """A panel for each quantity and height: measured points, the simulated curve and its band."""
    panels = list(table.groupby(["quantity", "height_m"], sort=False))
    columns = -(-len(panels) // 2) if len(panels) > 1 else 1
    with figure_style():
        figure, axes = plt.subplots(
            -(-len(panels) // columns), columns, squeeze=False, sharex=True,
            figsize=(DOUBLE_COLUMN_IN, PANEL_IN * -(-len(panels) // columns)),
        )  # fmt: skip
        for axis in axes.flat[len(panels) :]:
            axis.set_visible(False)
        for axis, ((quantity, height), points) in zip(axes.flat, panels, strict=False):
            curve = curves[(curves["quantity"] == quantity) & (curves["height_m"] == height)]
            x = 1e3 * curve["position_x_m"]
            axis.fill_between(x, curve["ci_low"], curve["ci_high"], color=SIMULATED, alpha=0.25, linewidth=0)
            axis.plot(x, curve["simulated"], color=SIMULATED, label="simulated, 95 % band")
            axis.plot(
                1e3 * points["position_x_m"], points["measured"], "o", color=LINE_COLOUR, markersize=3,
                markerfacecolor="none", label="measured",
            )  # fmt: skip
            axis.set(xlabel="x [mm]", ylabel=LABELS[str(quantity)], title=f"z = {1e3 * height:g} mm")
        axes.flat[0].legend(loc="lower center")
        save_figure(figure, png, pdf, resolution_dpi)


def validate_bed(
    trajectory: Path, metadata: Path, points: Path,
    table: Path, metrics: Path, png: Path, pdf: Path, csv: Path,
    start_s: float, end_s: float, diameter_m: float, width_m: float, thickness_m: float, resolution_dpi: int,
) -> None:  # fmt: skip
    """Average the bed over a window as the measurement does, and put both side by side.

    Parameters
    ----------
    trajectory, metadata : Path
        ``trajectory.npy``, ``trajectory.json``.
    points : Path
        Measured points, ``cases/<case>/measured.csv``.
    table, metrics : Path
        Get every point, and the differences with their aims.
    png, pdf, csv : Path
        Figure, and its curves.
    start_s, end_s : float
        The window [s].
    diameter_m, width_m, thickness_m : float
        Of particles and bed [m].
    resolution_dpi : int
        Of the png [dots per inch].
    """
    measured = read_points(points)
    store, described = open_trajectory(trajectory, metadata)
    frames = store[window(np.array(described["times_s"]), start_s, end_s)]
    bed = Bed(frames, described["frame_interval_s"], diameter_m / 2, width_m, thickness_m)
    compared, found = compare(measured, bed)
    found["aim"] = found["quantity"].map(AIMS)
    x = np.linspace(0, width_m, FINE_POINTS)
    panels = measured[["quantity", "height_m"]].drop_duplicates().itertuples(index=False)
    curves = pd.concat([simulated(bed, quantity, height, x)[0] for quantity, height in panels])
    draw(compared, curves, png, pdf, resolution_dpi)
    write_csv(curves, csv)
    write_csv(compared, table)
    write_csv(found, metrics)
    for row in found[found["aim"].notna()].itertuples():
        LOG.info("%s %.4g %s, aim %.4g: %s", row.quantity, row.value, row.unit, row.aim,
                 "met" if row.value <= row.aim else "missed")  # fmt: skip


if "snakemake" in globals():
    with stage(snakemake.log[0]):
        validate_bed(
            Path(snakemake.input.trajectory),
            Path(snakemake.input.metadata),
            Path(snakemake.input.points),
            Path(snakemake.output.table),
            Path(snakemake.output.metrics),
            Path(snakemake.output.png),
            Path(snakemake.output.pdf),
            Path(snakemake.output.csv),
            snakemake.params.start_s,
            snakemake.params.end_s,
            snakemake.params.diameter_m,
            snakemake.params.width_m,
            snakemake.params.thickness_m,
            snakemake.params.resolution_dpi,
        )
