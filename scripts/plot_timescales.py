# SPDX-License-Identifier: GPL-3.0-or-later
"""Implied timescales of the chains over the lag: level where a chain is Markov, unseen below the lag."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullFormatter

from bedchain.errors import UserError, make_again
from bedchain.figures.style import DOUBLE_COLUMN_IN, LINE_COLOUR, FigureFiles, figure_style
from bedchain.files import write_csv
from bedchain.stage import run_stage

# a pair of complex eigenvalues has one timescale; the same number twice up to the digits of the table
PAIR = 1e-6
PROCESSES = 3
MARKERS, DASHES = ("o", "s", "^"), ("-", (0, (4, 1.5)), (0, (1.2, 1.2)))
# error bars of processes beside each other, as a share of the lag
SHIFT = 0.035
UNSEEN_COLOUR, LEGEND_COLOUR = "#d9d9d9", "#444444"
TICKS_S = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20)


def plot_timescales(diagnostics: Path, files: FigureFiles, colours: dict[str, str]) -> None:
    """Draw the slowest timescales of each model over the lag, and where they cannot be seen.

    Parameters
    ----------
    diagnostics : Path
        ``diagnostics.csv`` of diagnose_chains.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    colours : dict of str to str
        Colour of each model; those without timescales in the table (no matrix) are left out.

    Raises
    ------
    UserError
        The table has no timescales of a model.
    """
    table = pd.read_csv(diagnostics).query("quantity == 'implied_timescale'")
    if table.empty or not set(table["source"]) <= set(colours):
        raise UserError(f"{diagnostics} lacks timescales of {', '.join(colours)}; {make_again(diagnostics)}")
    colours = {model: colour for model, colour in colours.items() if model in set(table["source"])}
    table = processes(table)
    lags = table["lag_s"].unique()
    shown = table[table["process"] <= PROCESSES]
    with figure_style():
        figure, panels = plt.subplots(
            1, len(colours), figsize=(DOUBLE_COLUMN_IN, 2.8), sharex=True, sharey=True, squeeze=False
        )
        ends = np.array([lags.min() / 1.25, lags.max() * 1.25])
        ends_s = (0.5 * shown[["timescale_s", "ci_low_s"]].min().min(), 1.3 * shown["ci_high_s"].max())
        for axes, (model, colour) in zip(panels[0], colours.items(), strict=True):
            _draw_model(axes, shown[shown["source"] == model], colour)
            axes.fill_between(ends, ends_s[0] * 1e-3, ends, color=UNSEEN_COLOUR, lw=0, zorder=0)
            axes.plot(ends, ends, color=LINE_COLOUR, lw=0.6, zorder=0)
            axes.set(xscale="log", yscale="log", xlim=ends, ylim=ends_s, xlabel="lag [s]")
            axes.set_title(f"{model} chain", loc="left")
            axes.set_xticks(lags, [f"{lag:g}" for lag in lags])
            axes.xaxis.set_minor_formatter(NullFormatter())
            axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axes.minorticks_off()
            axes.set_yticks([tick for tick in TICKS_S if ends_s[0] < tick < ends_s[1]])
            axes.text(
                ends[1] / 1.05, lags.max() / 3, "not resolved:\ntimescale < lag", ha="right", va="center",
                fontsize=7, color="#333333",
            )  # fmt: skip
        panels[0, 0].set_ylabel("implied timescale [s]")
        figure.legend(handles=_legend(), loc="outside upper center", ncols=5, handlelength=2.8)
        files.save(figure)
    write_csv(table, files.csv)


def processes(table: pd.DataFrame) -> pd.DataFrame:
    """Timescales by process: a pair of complex eigenvalues is one process that goes round.

    Parameters
    ----------
    table : DataFrame
        Rows of diagnostics.csv: source, lag_s, part (1 the slowest), value, ci_low, ci_high.

    Returns
    -------
    DataFrame
        source, lag_s, process (1 the slowest), timescale_s, ci_low_s, ci_high_s, turns (1 for a pair).
    """
    parts = []
    for (source, lag), found in table.groupby(["source", "lag_s"], sort=False):
        found = found.assign(part=found["part"].astype(int)).sort_values("part")
        scales = found["value"].to_numpy()
        same = np.isclose(scales[1:], scales[:-1], rtol=PAIR, atol=0)
        first = np.concatenate(([True], ~same))
        kept = found[first]
        part = kept[["value", "ci_low", "ci_high"]].set_axis(["timescale_s", "ci_low_s", "ci_high_s"], axis=1)
        part.insert(0, "source", source)
        part.insert(1, "lag_s", lag)
        part.insert(2, "process", np.arange(1, len(kept) + 1))
        part["turns"] = np.concatenate((same, [False]))[first].astype(int)
        parts.append(part)
    return pd.concat(parts, ignore_index=True)


def _draw_model(axes: Axes, table: pd.DataFrame, colour: str) -> None:
    for number, (marker, dash) in enumerate(zip(MARKERS, DASHES, strict=True)):
        found = table[table["process"] == number + 1].sort_values("lag_s")
        lag, scale = found["lag_s"] * (1 + SHIFT * (number - 1)), found["timescale_s"]
        axes.plot(lag, scale, color=colour, linestyle=dash, marker=marker, ms=4.5)
        turns = found["turns"] == 1
        axes.plot(
            lag[turns], scale[turns], color=colour, linestyle="none", marker=marker, ms=4.5, mfc="white"
        )
        # the ends of a band need not hold the value itself: blocks that are drawn twice make a chain slower
        axes.vlines(lag, found["ci_low_s"], found["ci_high_s"], color=colour, lw=0.8, alpha=0.8)


def _legend() -> list[Line2D]:
    names = ("slowest process", "second", "third")
    grey: dict[str, Any] = {"color": LEGEND_COLOUR, "ms": 4.5}
    styles = zip(names, MARKERS, DASHES, strict=True)
    handles = [Line2D([], [], label=name, marker=marker, ls=dash, **grey) for name, marker, dash in styles]
    handles.append(Line2D([], [], label="open: goes round", marker="o", ls="none", mfc="white", **grey))
    return [*handles, Line2D([], [], label="95 % band", marker="|", ls="none", color=LEGEND_COLOUR, ms=9)]


if rule := globals().get("snakemake"):
    run_stage(plot_timescales, rule)
