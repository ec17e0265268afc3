# SPDX-License-Identifier: GPL-3.0-or-later
"""Chapman-Kolmogorov test: mixing by chains of several lags beside what the DEM shows in the same window."""

from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, MaxNLocator

from bedchain.errors import UserError, make_again
from bedchain.figures.model_styles import label
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style, footnote
from bedchain.files import write_csv
from bedchain.stage import run_stage

GROUPS = {"left": "left half", "right": "right half", "low": "lower part", "up": "upper part"}
CURVES = ("remaining_propagated", "remaining_counted")
# every other one of the doubled lags: the curves between them lie between theirs
LAG_STRIDE = 2
STYLES: tuple[tuple[Any, str], ...] = (
    ((0, (4, 1.5)), ""),
    ((0, (1.2, 1.2)), "o"),
    ("none", "s"),
    ("none", "^"),
)
BAND_OPACITY = 0.3
BAND_COLOUR = "#888888"
ROW_HEIGHT_IN = 1.75


def plot_chapman_kolmogorov(diagnostics: Path, files: FigureFiles, colours: dict[str, str]) -> None:
    """Draw each group of each model: the DEM, and chains of several lags carried on step by step.

    Parameters
    ----------
    diagnostics : Path
        ``diagnostics.csv`` of diagnose_chains.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    colours : dict of str to str
        Colours of ``dem`` and of each model; those without curves in the table (no matrix) are left out.

    Raises
    ------
    UserError
        The table has no such curves.
    """
    table = pd.read_csv(diagnostics).query("quantity in @CURVES")
    models = [source for source in colours if source != "dem" and source in set(table["source"])]
    if not models or set(table["source"]) != {"dem", *models}:
        raise UserError(f"{diagnostics} lacks curves of {', '.join(colours)}; {make_again(diagnostics)}")
    lags = sorted(table["lag_s"].dropna().unique())[::LAG_STRIDE][: len(STYLES)]
    with figure_style():
        figure, panels = plt.subplots(
            len(models), len(GROUPS), figsize=(DOUBLE_COLUMN_IN, ROW_HEIGHT_IN * len(models) + 0.5),
            sharex=True, sharey=True, squeeze=False,
        )  # fmt: skip
        for row, model in zip(panels, models, strict=True):
            for axes, group in zip(row, GROUPS, strict=True):
                of_group = table[table["part"] == group]
                _draw_dem(axes, of_group[of_group["source"] == "dem"], colours["dem"])
                _draw_chains(axes, of_group[of_group["source"] == model], lags, colours[model])
            row[0].set_ylabel(f"{label(model)}\nshare still on its side [1]")
        for axes, name in zip(panels[0], GROUPS.values(), strict=True):
            axes.set_title(name, loc="left")
        for axes in panels[-1]:
            axes.set_xlabel("time [s]")
            axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axes.xaxis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))
        panels[0, 0].set_xlim(0, table["time_s"].max())
        panels[0, 0].set_ylim(None, 1.03)
        banded = table.loc[table["source"] == "dem", "ci_low"].notna().any()
        _legend(figure, lags, colours, bool(banded))
        if absent := missing_lags(table, models, lags):
            footnote(figure, absent)
        files.save(figure)
    columns = ["source", "lag_s", "time_s", "part", "value", "ci_low", "ci_high"]
    names = {
        "part": "group",
        "value": "fraction_remaining_1",
        "ci_low": "band_low_1",
        "ci_high": "band_high_1",
    }
    write_csv(table[columns].rename(columns=names), files.csv)


def missing_lags(table: pd.DataFrame, models: list[str], lags: list[float]) -> str:
    """A sentence for each model that was not learned at some of the lags."""
    by_model = {model: {*table.loc[table["source"] == model, "lag_s"]} for model in models}
    absent = {model: [f"{lag:g}" for lag in lags if lag not in has] for model, has in by_model.items()}
    return " ".join(
        f"{label(model).capitalize()}: not learned at {' and '.join(which)} s, too many states."
        for model, which in absent.items()
        if which
    )


def _draw_dem(axes: Axes, curve: pd.DataFrame, colour: str) -> None:
    curve = curve.sort_values("time_s")
    time, share = [0.0, *curve["time_s"]], [1.0, *curve["value"]]
    axes.fill_between(curve["time_s"], curve["ci_low"], curve["ci_high"], color=BAND_COLOUR,
                      alpha=BAND_OPACITY, linewidth=0)  # fmt: skip
    axes.plot(time, share, color=colour, lw=1.6)
    axes.grid(axis="y", color="#e2e2e2", linewidth=0.5)
    axes.set_axisbelow(True)


def _draw_chains(axes: Axes, table: pd.DataFrame, lags: list[float], colour: str) -> None:
    for lag, (dash, marker) in zip(lags, STYLES, strict=False):
        curve = table[table["lag_s"] == lag].sort_values("time_s")
        axes.plot(curve["time_s"], curve["value"], color=colour, linestyle=dash, marker=marker, ms=3.4,
                  mfc="white", mew=0.9, zorder=3)  # fmt: skip


def _legend(figure: Figure, lags: list[float], colours: dict[str, str], banded: bool) -> None:
    handles: list[Artist] = [
        Line2D([], [], color=colours["dem"], lw=1.6),
        Patch(color=BAND_COLOUR, alpha=BAND_OPACITY, lw=0),
    ]
    labels = ["DEM", "its 95 % band"] if banded else ["DEM", "no band: window too short"]
    for lag, (dash, marker) in zip(lags, STYLES, strict=False):
        handles.append(
            Line2D([], [], color="#444444", linestyle=dash, marker=marker, ms=3.4, mfc="white", mew=0.9)
        )
        labels.append(f"chain, lag {lag:g} s")
    figure.legend(handles, labels, loc="outside upper center", ncols=5, handlelength=2.6, columnspacing=1.4)


if rule := globals().get("snakemake"):
    run_stage(plot_chapman_kolmogorov, rule)
