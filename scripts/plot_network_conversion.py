# SPDX-License-Identifier: GPL-3.0-or-later
"""Conversion over height: share of the feed that has not reacted below a height, by each model."""

from pathlib import Path

import pandas as pd
from matplotlib import pyplot as plt

from bedchain.figures.network_styles import colours_of, figure_legend
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style
from bedchain.files import write_csv
from bedchain.stage import run_stage

# shares below this are not shown
LEAST = 1e-4


def plot_network_conversion(conversion: Path, files: FigureFiles) -> None:
    """Draw conversion, and what is left on a logarithmic axis, over height.

    Parameters
    ----------
    conversion : Path
        ``conversion.csv`` of run_network.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    """
    table = pd.read_csv(conversion)
    colours = colours_of(table["chain"])
    with figure_style():
        figure, panels = plt.subplots(1, 2, figsize=(DOUBLE_COLUMN_IN, 2.9))
        for name, part in table.groupby("chain", sort=False):
            panels[0].plot(part["height_m"], part["conversion_1"], color=colours[name], label=name)
            panels[1].plot(part["height_m"], 1 - part["conversion_1"], color=colours[name], label=name)
        panels[0].set(xlabel="height [m]", ylabel="conversion [1]", xlim=(0, None), ylim=(0, 1.02))
        panels[1].set(xlabel="height [m]", ylabel="share not converted [1]", xlim=(0, None), yscale="log")
        panels[1].set_ylim(LEAST, 1)
        figure_legend(figure, list(panels))
        files.save(figure)
    write_csv(table, files.csv)


if rule := globals().get("snakemake"):
    run_stage(plot_network_conversion, rule)
