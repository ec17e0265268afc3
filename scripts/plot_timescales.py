# SPDX-License-Identifier: GPL-3.0-or-later
"""Implied timescales of the chains by lag: level where a chain is Markov, not resolved below the lag."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, NullFormatter

from bedchain.errors import UserError, make_again
from bedchain.figures.model_styles import label
from bedchain.figures.style import DOUBLE_COLUMN_IN, LINE_COLOUR, FigureFiles, figure_style, footnote
from bedchain.files import write_csv
from bedchain.stage import run_stage

# a pair of complex eigenvalues has one timescale; the same number twice up to the digits of the table
PAIR = 1e-6
PROCESSES = 3
MARKERS = ("o", "s", "^")
# error bars of processes beside each other, as a share of the lag
SHIFT = 0.06
NOTE = """The three slowest processes are ranked anew at each lag: marks of one rank need not be the same
process, so no line joins them. {bands}"""
BANDS = "Without a bar: the learning window is too short for a 95 % band."
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
        drawn = shown[["timescale_s", "ci_low_s", "ci_high_s"]]
        # without bands the window is too short for them
        ends_s = (0.5 * drawn.min().min(), 1.3 * drawn.max().max())
        for axes, (model, colour) in zip(panels[0], colours.items(), strict=True):
            _draw_model(axes, shown[shown["source"] == model], colour)
            axes.fill_between(ends, ends_s[0] * 1e-3, ends, color=UNSEEN_COLOUR, lw=0, zorder=0)
            axes.plot(ends, ends, color=LINE_COLOUR, lw=0.6, zorder=0)
            axes.set(xscale="log", yscale="log", xlim=ends, ylim=ends_s, xlabel="lag [s]")
            axes.set_title(label(model), loc="left")
            axes.set_xticks(lags, [f"{lag:g}" for lag in lags])
            axes.xaxis.set_minor_formatter(NullFormatter())
            axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axes.minorticks_off()
            axes.set_yticks([tick for tick in TICKS_S if ends_s[0] < tick < ends_s[1]])
        panels[0, 0].set_ylabel("implied timescale [s]")
        figure.legend(handles=_legend(), loc="outside upper center", ncols=6, handlelength=1.4)
        footnote(figure, NOTE.format(bands=BANDS if shown["ci_low_s"].isna().any() else ""))
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
    for number, marker in enumerate(MARKERS):
        rows = table[table["process"] == number + 1].sort_values("lag_s")
        lag, scale = rows["lag_s"] * (1 + SHIFT * (number - 1)), rows["timescale_s"]
        axes.vlines(lag, rows["ci_low_s"], rows["ci_high_s"], color=colour, lw=1.0)
        for turns, face in ((0, colour), (1, "white")):
            part = rows["turns"] == turns
            axes.plot(lag[part], scale[part], color=colour, linestyle="none", marker=marker, ms=4.5, mfc=face)


def _legend() -> list[Artist]:
    names = ("slowest process", "second", "third")
    grey: dict[str, Any] = {"color": LEGEND_COLOUR, "ms": 4.5, "ls": "none"}
    handles: list[Artist] = [
        Line2D([], [], label=name, marker=marker, **grey) for name, marker in zip(names, MARKERS, strict=True)
    ]
    handles.append(Line2D([], [], label="open: oscillates", marker="o", mfc="white", **grey))
    handles.append(Line2D([], [], label="95 % band", marker="|", ls="none", color=LEGEND_COLOUR, ms=9))
    return [*handles, Patch(color=UNSEEN_COLOUR, lw=0, label="not resolved: below the lag")]


if rule := globals().get("snakemake"):
    run_stage(plot_timescales, rule)
