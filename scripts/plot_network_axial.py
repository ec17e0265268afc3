# SPDX-License-Identifier: GPL-3.0-or-later
"""Axial mixing by written-down chains beside the DEM runs and the learned chains of Fig. 5b."""

from pathlib import Path

import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

from bedchain.figures.network_styles import colours_of, figure_legend
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style
from bedchain.files import write_csv
from bedchain.stage import run_stage

DEM = r"dem(_\d+)?"
TITLES = {"low": "particles that start low", "up": "particles that start up"}


def plot_network_axial(axial: Path, files: FigureFiles) -> None:
    """Draw the share of low and of up on its side: the range of the DEM runs as a band, chains as curves.

    Parameters
    ----------
    axial : Path
        ``axial.csv`` of run_network.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    """
    table = pd.read_csv(axial)
    with figure_style():
        figure, panels = plt.subplots(1, 2, figsize=(DOUBLE_COLUMN_IN, 2.9), sharey=True)
        for axes, (group, title) in zip(panels, TITLES.items(), strict=True):
            draw(axes, table[table["group"] == group])
            axes.set(xlabel="time [s]", xlim=(0, None), ylim=(0, 1.02))
            axes.set_title(title, loc="left", fontsize=7)
        panels[0].set_ylabel("share still on its side [1]")
        figure_legend(figure, list(panels))
        files.save(figure)
    write_csv(table, files.csv)


def draw(axes: Axes, part: pd.DataFrame) -> None:
    """Curves of a group."""
    dem = part[part["source"].str.fullmatch(DEM)]
    runs = dem.groupby("time_s")["fraction_remaining_1"]
    band = pd.DataFrame({"low": runs.min(), "up": runs.max(), "mean": runs.mean()})
    axes.fill_between(band.index, band["low"], band["up"], color="#222222", alpha=0.2, lw=0, label="DEM runs")
    axes.plot(band.index, band["mean"], color="#222222", label="their mean")
    others = part[~part["source"].str.fullmatch(DEM)]
    colours = colours_of(others["source"])
    for source, curve in others.groupby("source", sort=False):
        learned = source in ("static", "chosen")
        label = f"{source} (learned)" if learned else source
        dash = (0, (4, 1.5)) if learned else "-"
        axes.plot(
            curve["time_s"], curve["fraction_remaining_1"], color=colours[source], ls=dash, lw=1, label=label
        )


if rule := globals().get("snakemake"):
    run_stage(plot_network_axial, rule)
