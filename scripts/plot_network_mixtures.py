# SPDX-License-Identifier: GPL-3.0-or-later
"""Mixtures over the revolutions of a mixer: variance of the key's content and Lacey's index."""

from pathlib import Path

import pandas as pd
from matplotlib import pyplot as plt

from bedchain.figures.network_styles import colours_of
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style
from bedchain.files import write_csv
from bedchain.stage import run_stage

PANELS = {
    "content_variance": "variance of the key's content\nover that of the start [1]",
    "lacey_index": "Lacey's mixing index [1]",
}
# variances below this share of the start's are not shown: no sample could tell them from 0
LEAST = 1e-6


def plot_network_mixtures(mixtures: Path, files: FigureFiles) -> None:
    """Draw both measures, a colour a mixture, with a ring at the smallest variance.

    Parameters
    ----------
    mixtures : Path
        ``mixtures.csv`` of run_network.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    """
    table = pd.read_csv(mixtures)
    colours = colours_of(table["mixture"])
    with figure_style():
        figure, panels = plt.subplots(1, 2, figsize=(DOUBLE_COLUMN_IN, 3.0))
        for axes, (quantity, label) in zip(panels, PANELS.items(), strict=True):
            for name, part in table[table["quantity"] == quantity].groupby("mixture", sort=False):
                axes.plot(part["revolution"], part["value"], ".-", color=colours[name], label=name, ms=4)
                best = part.loc[part["value"].idxmin()]
                inner = best["revolution"] < part["revolution"].max()  # else it falls on
                if quantity == "content_variance" and inner and best["value"] > LEAST:
                    axes.plot(best["revolution"], best["value"], "o", mfc="none", color=colours[name], ms=9)
            axes.set(xlabel="revolutions [1]", ylabel=label, xlim=(0, None))
        panels[0].set_yscale("log")
        panels[0].set_ylim(LEAST, 2)
        panels[1].set_ylim(0, 1.03)
        figure.legend(*panels[1].get_legend_handles_labels(), loc="outside lower center", ncols=3)
        files.save(figure)
    write_csv(table, files.csv)


if rule := globals().get("snakemake"):
    run_stage(plot_network_mixtures, rule)
