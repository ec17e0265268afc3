# SPDX-License-Identifier: GPL-3.0-or-later
"""The lag and the cells by rule: dispersion of the particles over the lag, and what cells add to it."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

from bedchain.figures.style import (
    DOUBLE_COLUMN_IN,
    LINE_COLOUR,
    FigureFiles,
    figure_style,
    footnote,
    label_parts,
)
from bedchain.files import write_csv
from bedchain.measures.choice import REACHED
from bedchain.measures.choice_of_cells import MOST_ADDED
from bedchain.stage import run_stage

COLOURS = {"x": "#4477aa", "z": "#ee6677"}
DASHES = {"x": "-", "z": (0, (4, 1.5))}
BAND_OPACITY = 0.2
NOTE = """Left: variance of the particles' displacements over twice the lag, in colour 95 % bands; chosen
is the first lag at which both axes reach {reached:.0f} % (dotted), or a later one if memory remains; grey:
lags chosen when a fifth of the window is left out. Right: chosen are the largest cells that add less than
{added:.0f} % (dotted) along both axes."""
SHOWN_LAGS = 4  # as many times the chosen lag: later ones only show that particles have seen the whole bed


def plot_choice(choice: Path, curve: Path, files: FigureFiles) -> None:
    """Draw why a lag and cells were chosen.

    Parameters
    ----------
    choice, curve : Path
        ``choice.csv`` and ``choice_curve.csv`` of choose_chain.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    """
    chosen = pd.read_csv(choice).set_index("quantity")["value"]
    table = pd.read_csv(curve)
    with figure_style():
        figure, (left, right) = plt.subplots(1, 2, figsize=(DOUBLE_COLUMN_IN, 3.1))
        _draw_dispersion(left, table[table["quantity"] == "dispersion"], chosen)
        _draw_added(right, table[table["quantity"] == "added_share"], chosen)
        figure.legend(
            *left.get_legend_handles_labels(), loc="outside upper center", ncols=4, handlelength=2.4
        )
        footnote(figure, NOTE.format(reached=100 * REACHED, added=100 * MOST_ADDED))
        files.save(figure)
    write_csv(table, files.csv)


def _draw_dispersion(axes: Axes, table: pd.DataFrame, chosen: pd.Series) -> None:
    """Dispersion over its maximum, so that both axes are in one panel."""
    lag_s = float(chosen["lag_s"])
    shown = table[table["lag_s"] <= max(SHOWN_LAGS * lag_s, 1.2 * table["lag_s"].min())]
    for axis, part in shown.groupby("axis"):
        top = table.loc[table["axis"] == axis, "value"].max()
        if not top > 0:
            continue
        name = f"along {axis}, largest {1e4 * top:.3g} cm²/s"
        axes.plot(part["lag_s"], part["value"] / top, color=COLOURS[axis], ls=DASHES[axis], label=name)
        axes.fill_between(
            part["lag_s"], part["ci_low"] / top, part["ci_high"] / top, color=COLOURS[axis],
            alpha=BAND_OPACITY, linewidth=0,
        )  # fmt: skip
    axes.axhline(REACHED, color=LINE_COLOUR, lw=0.6, ls=":")
    axes.axvspan(chosen["lag_low_s"], chosen["lag_high_s"], color="#dddddd", lw=0, zorder=0)
    axes.axvline(lag_s, color=LINE_COLOUR, lw=1.0, label="chosen")
    axes.set(xlabel="lag [s]", ylabel="dispersion over its maximum [1]", ylim=(0, None), xlim=(0, None))
    axes.set_title(f"lag {lag_s:g} s", loc="left")


def _draw_added(axes: Axes, table: pd.DataFrame, chosen: pd.Series) -> None:
    for axis, part in table[table["value"] > 0].groupby("axis"):
        axes.plot(
            100 * part["cell_m"], 100 * part["value"], color=COLOURS[axis], ls=DASHES[axis], marker="o", ms=3
        )
    axes.axhline(100 * MOST_ADDED, color=LINE_COLOUR, lw=0.6, ls=":")
    axes.axvline(100 * chosen["cell_m"], color=LINE_COLOUR, lw=1.0)
    sizes = 100 * np.sort(table["cell_m"].unique())
    axes.set(xscale="log", yscale="log", xlabel="side of a cell [cm]", xlim=(0.9 * sizes[0], 1.1 * sizes[-1]))
    axes.set_ylabel("dispersion that the cells add [%]")
    for axis in (axes.xaxis, axes.yaxis):
        label_parts(axis, (1, 3))
    axes.set_title(f"{chosen['columns']:.0f} x {chosen['rows']:.0f} cells", loc="left")


if rule := globals().get("snakemake"):
    run_stage(plot_choice, rule)
