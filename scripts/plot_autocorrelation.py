# SPDX-License-Identifier: GPL-3.0-or-later
"""Velocity autocorrelation and mean-square displacement of particles: DEM and all models."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

from bedchain.errors import UserError, make_again
from bedchain.figures.model_styles import BASELINE, label, model_styles
from bedchain.figures.style import DOUBLE_COLUMN_IN, LINE_COLOUR, FigureFiles, figure_style, label_parts
from bedchain.files import write_csv
from bedchain.stage import run_stage

ROWS = {"x": "along x", "z": "along z"}


def plot_autocorrelation(lagrangian: Path, files: FigureFiles, dem_colour: str) -> None:
    """Draw displacement autocorrelation and mean-square displacement, along x and z.

    Parameters
    ----------
    lagrangian : Path
        ``scores_lagrangian.csv``.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    dem_colour : str
        Colour of the DEM.

    Raises
    ------
    UserError
        The DEM is missing.
    """
    table = pd.read_csv(lagrangian)
    if "dem" not in set(table["source"]):
        raise UserError(f"{lagrangian} lacks the DEM; {make_again(lagrangian)}")
    with figure_style():
        figure, panels = plt.subplots(2, 2, figsize=(DOUBLE_COLUMN_IN, 4.8), sharex="col")
        for (auto, msd), (axis, name) in zip(panels, ROWS.items(), strict=True):
            part = table[table["axis"] == axis]
            _draw(auto, part, "autocorrelation_1", dem_colour)
            _draw(msd, part[part["time_s"] > 0].assign(cm2=1e4 * part["msd_m2"]), "cm2", dem_colour)
            auto.axhline(0, color=LINE_COLOUR, lw=0.6)
            auto.set_ylabel("displacement autocorrelation [1]")
            spans = sorted({f"{span:g} s" for span in part["span_s"]})
            auto.set_title(f"{name}, displacements over {' or '.join(spans)}", loc="left")
            msd.set(xscale="log", yscale="log", ylabel="mean-square displacement [cm²]")
            label_parts(msd.xaxis, (1, 2, 5))
        for axes in panels[-1]:
            axes.set_xlabel("time between [s]")
        handles, labels = panels[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper center", ncols=3, handlelength=2.8)
        files.save(figure)
    write_csv(table, files.csv)


def _draw(axes: Axes, table: pd.DataFrame, column: str, dem_colour: str) -> None:
    styles = model_styles(set(table["source"]) - {"dem"})
    for source, curve in table.groupby("source", sort=False):
        if source == "dem":
            axes.plot(curve["time_s"], curve[column], color=dem_colour, lw=2.0, label="DEM")
            continue
        style = styles[str(source)]
        axes.plot(
            curve["time_s"], np.where(curve[column] == 0, np.nan, curve[column]), color=style.colour,
            ls=style.dash, marker=style.marker, ms=3, mfc="white" if source == BASELINE else style.colour,
            label=label(str(source)),
        )  # fmt: skip
    axes.grid(axis="y", color="#e2e2e2", linewidth=0.5)
    axes.set_axisbelow(True)


if rule := globals().get("snakemake"):
    run_stage(plot_autocorrelation, rule)
