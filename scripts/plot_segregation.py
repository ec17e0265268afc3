# SPDX-License-Identifier: GPL-3.0-or-later
"""Marked particles over time: Lacey index, variation and separation by height, DEM beside chains."""

from pathlib import Path

import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

from bedchain.figures.style import DOUBLE_COLUMN_IN, LINE_COLOUR, FigureFiles, figure_style
from bedchain.files import write_csv
from bedchain.stage import run_stage

LABELS = {
    "lacey_index": "Lacey index [1]",
    "coefficient_of_variation": "coefficient of variation [1]",
    "height_separation": "separation by height [1]",
}
# limits of the index: separated, and the expected index of a random mixture
LIMITS = {"lacey_index": {"separated": 0.0, "random": 1.0}, "height_separation": {"random": 0.0}}
NAMES = {"dem": "DEM", "chain": "one chain for all", "chain_by_mark": "a chain for each"}
DASHES = {"dem": "-", "chain": (0, (1.2, 1.2)), "chain_by_mark": (0, (4, 1.5))}


def plot_segregation(segregation: Path, files: FigureFiles, colours: dict[str, str]) -> None:
    """Draw a row of panels for each mark, with bands of the chains.

    Parameters
    ----------
    segregation : Path
        ``segregation.csv`` of measure_segregation.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    colours : dict of str to str
        Of dem, chain and chain_by_mark.
    """
    table = pd.read_csv(segregation)
    marks = list(dict.fromkeys(table["mark"]))
    with figure_style():
        figure, panels = plt.subplots(
            len(marks),
            len(LABELS),
            figsize=(DOUBLE_COLUMN_IN, 0.5 + 1.9 * len(marks)),
            squeeze=False,
            sharex=True,
        )
        for row, mark in zip(panels, marks, strict=True):
            for axes, (quantity, label) in zip(row, LABELS.items(), strict=True):
                part = table[(table["mark"] == mark) & (table["quantity"] == quantity)]
                _draw(axes, part, colours)
                _draw_limits(axes, part, quantity)
                axes.set(ylabel=label, xlim=(0, None))
            row[0].set_title(f"marked: {mark}", loc="left")
        for axes in panels[-1]:
            axes.set_xlabel("time [s]")
        handles, labels = panels[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper center", ncols=len(labels), handlelength=2.8)
        files.save(figure)
    write_csv(table, files.csv)


def _draw(axes: Axes, table: pd.DataFrame, colours: dict[str, str]) -> None:
    for source, colour in colours.items():
        part = table[(table["source"] == source) & table["time_s"].notna()]
        if len(part):
            axes.fill_between(part["time_s"], part["ci_low"], part["ci_high"], color=colour, alpha=0.2, lw=0)
            axes.plot(part["time_s"], part["value"], color=colour, ls=DASHES[source], label=NAMES[source])


def _draw_limits(axes: Axes, table: pd.DataFrame, quantity: str) -> None:
    limits = LIMITS.get(quantity, {})
    given = table[table["source"].isin(["separated", "random"])]
    for name, value in (limits | dict(zip(given["source"], given["value"], strict=True))).items():
        axes.axhline(value, color=LINE_COLOUR, lw=0.5, ls=":")
        axes.text(
            0.99, value, name, ha="right", va="bottom", fontsize=6, color=LINE_COLOUR,
            transform=axes.get_yaxis_transform(),
        )  # fmt: skip


if rule := globals().get("snakemake"):
    run_stage(plot_segregation, rule)
