# SPDX-License-Identifier: GPL-3.0-or-later
"""Path of one particle through each network: its height over time, a colour a zone."""

from pathlib import Path

import pandas as pd

from bedchain.figures.network_styles import colours_of, figure_legend, panels_of, with_text
from bedchain.figures.style import FigureFiles, figure_style
from bedchain.files import write_csv
from bedchain.stage import run_stage

MOST_CHAINS = 4


def plot_network_path(path: Path, files: FigureFiles) -> None:
    """Draw the paths of the first chains whose states have heights.

    Parameters
    ----------
    path : Path
        ``path.csv`` of run_network.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    """
    table = with_text(pd.read_csv(path), "zone").dropna(subset="height_m")
    names = list(dict.fromkeys(table["chain"]))[:MOST_CHAINS]
    colours = colours_of(table["zone"])
    with figure_style():
        figure, panels = panels_of(names)
        for axes, name in zip(panels, names, strict=True):
            part = table[table["chain"] == name]
            axes.step(part["time_s"], part["height_m"], where="post", color="#bbbbbb", lw=0.6)
            for zone, places in part.groupby("zone", sort=False):
                axes.plot(
                    places["time_s"], places["height_m"], ".", color=colours[zone], ms=3, label=zone or None
                )
            axes.set(xlabel="time [s]", ylabel="height [m]", xlim=(0, None), ylim=(0, None))
        figure_legend(figure, panels, markerscale=2)
        files.save(figure)
    write_csv(table, files.csv)


if rule := globals().get("snakemake"):
    run_stage(plot_network_path, rule)
