# SPDX-License-Identifier: GPL-3.0-or-later
"""Contents that follow a start, over height, at some moments."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.lines import Line2D

from bedchain.figures.network_styles import DASHES, panels_of, with_text
from bedchain.figures.style import FigureFiles, figure_style
from bedchain.files import write_csv
from bedchain.stage import run_stage


def plot_network_pulses(pulses: Path, files: FigureFiles) -> None:
    """Draw the contents of every chain, a colour a moment and a dash a zone.

    Parameters
    ----------
    pulses : Path
        ``pulses.csv`` of run_network.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    """
    table = with_text(pd.read_csv(pulses), "zone").dropna(subset="height_m")
    # a zone of a single state is no curve over height, and its content would hide the others'
    heights = table.groupby(["chain", "zone"])["height_m"].transform("nunique")
    drawn = table[heights > 1] if (heights > 1).any() else table
    zones = list(dict.fromkeys(drawn["zone"]))
    times = sorted(set(table["moment_s"]))
    colours = dict(zip(times, plt.get_cmap("viridis")(np.linspace(0, 0.9, len(times))), strict=True))
    with figure_style():
        figure, panels = panels_of(list(dict.fromkeys(drawn["chain"])))
        for axes, (_, part) in zip(panels, drawn.groupby("chain", sort=False), strict=True):
            for (time, zone), states in part.groupby(["moment_s", "zone"], sort=False):
                dash = DASHES[zones.index(zone) % len(DASHES)]
                axes.plot(states["content"], states["height_m"], color=colours[time], ls=dash)
            axes.set(xlabel="content of the start", ylabel="height [m]", xlim=(0, None), ylim=(0, None))
        handles = [Line2D([], [], color=colours[time]) for time in times]
        labels = [f"{time:.3g} s" for time in times]
        if len(zones) > 1:
            handles += [
                Line2D([], [], color="#222222", ls=DASHES[at % len(DASHES)]) for at in range(len(zones))
            ]
            labels += zones
        figure.legend(handles, labels, loc="outside lower center", ncols=min(8, len(labels)))
        files.save(figure)
    write_csv(table, files.csv)


if rule := globals().get("snakemake"):
    run_stage(plot_network_pulses, rule)
