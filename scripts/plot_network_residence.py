# SPDX-License-Identifier: GPL-3.0-or-later
"""Residence times of open networks: F and E over the time after entering, by exit."""

from pathlib import Path

import pandas as pd
from matplotlib import pyplot as plt

from bedchain.figures.network_styles import DASHES, colours_of
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style
from bedchain.files import write_csv
from bedchain.stage import run_stage

PANELS = {
    "left_share_1": "F: share that has left [1]",
    "leaving_rate_1_s": "E: share that leaves [1/s]",
}


def plot_network_residence(residence: Path, files: FigureFiles) -> None:
    """Draw both distributions, a colour a chain and a dash an exit.

    Parameters
    ----------
    residence : Path
        ``residence.csv`` of run_network.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    """
    table = pd.read_csv(residence)
    colours, exits = colours_of(table["chain"]), list(dict.fromkeys(table["exit"]))
    with figure_style():
        figure, panels = plt.subplots(1, 2, figsize=(DOUBLE_COLUMN_IN, 2.8))
        for axes, (column, label) in zip(panels, PANELS.items(), strict=True):
            for (chain, way), part in table.groupby(["chain", "exit"], sort=False):
                name = chain if len(exits) == 1 else f"{chain}: {way}"
                dash = DASHES[exits.index(way) % len(DASHES)]
                axes.plot(part["time_s"], part[column], color=colours[chain], ls=dash, label=name)
            axes.set(xlabel="time after entering [s]", ylabel=label, xlim=(0, None), ylim=(0, None))
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
        files.save(figure)
    write_csv(table, files.csv)


if rule := globals().get("snakemake"):
    run_stage(plot_network_residence, rule)
