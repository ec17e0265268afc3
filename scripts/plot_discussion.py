# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of the chains by cell size and by lag, and the two effects behind them, as dispersion."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullLocator

from bedchain.errors import UserError, make_again
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style
from bedchain.files import write_csv
from bedchain.stage import run_stage

DIRECTIONS = {"left and right": ["left", "right"], "low and up": ["low", "up"]}
STYLES = {"left and right": ("-", "o"), "low and up": ((0, (4, 1.5)), "s")}
NOISE_COLOUR = "#888888"
NOISE_OPACITY = 0.2
SHADES = "viridis"
CM, CM2 = 100.0, 1e4
# below the curves, on the logarithmic axis
LEGEND_ROOM = 0.35


def plot_discussion(
    discussion: Path, files: FigureFiles, own_cell_m: float, own_lag_s: float, colours: dict[str, str]
) -> None:
    """Draw the signed errors over cell size and lag, and what spreads the particles.

    Parameters
    ----------
    discussion : Path
        ``discussion.csv``.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    own_cell_m, own_lag_s : float
        Of the case's own chains [m], [s].
    colours : dict of str to str
        Colours of ``dem`` and of each model.

    Raises
    ------
    UserError
        The case's own cells or lag are not in the table.
    """
    table = pd.read_csv(discussion)
    errors = table[table["quantity"] == "error_signed"]
    own = {
        "cell_m": np.isclose(errors["cell_m"], own_cell_m),
        "lag_s": np.isclose(errors["lag_s"], own_lag_s),
    }
    if not (own["cell_m"] & own["lag_s"]).any():
        raise UserError(f"{discussion} is of other cells or another lag; {make_again(discussion)}")
    with figure_style():
        figure, panels = plt.subplots(1, 3, figsize=(DOUBLE_COLUMN_IN, 2.9))
        _draw_errors(panels[0], errors[own["lag_s"]], "cell_m", colours, CM)
        _draw_errors(panels[1], errors[own["cell_m"]], "lag_s", colours, 1.0)
        for axes in panels[:2]:
            _draw_noise(axes, table)
        panels[1].sharey(panels[0])
        panels[0].set(xlabel="cell size [cm]", ylabel="mean of chain - DEM [1]")
        panels[0].set_title(f"lag {own_lag_s:g} s", loc="left")
        panels[1].set(xlabel="lag [s]")
        panels[1].set_title(f"cells of {CM * own_cell_m:.2g} cm", loc="left")
        _draw_dispersion(panels[2], table[table["part"] == "x"])
        handles, labels = panels[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper left", ncols=3, handlelength=2.6)
        files.save(figure)
    write_csv(table, files.csv)


def _draw_errors(axes: Axes, errors: pd.DataFrame, over: str, colours: dict[str, str], factor: float) -> None:
    """Mean error of both groups of a direction, for each model."""
    for model, rows in errors.groupby("source", sort=False):
        for name, groups in DIRECTIONS.items():
            mean = rows[rows["part"].isin(groups)].groupby(over)["value"].mean()
            line, marker = STYLES[name]
            axes.semilogx(
                factor * mean.index, mean, color=colours[str(model)], linestyle=line, marker=marker, ms=3,
                label=f"{model}, {name}",
            )  # fmt: skip
    axes.axhline(0, color="black", lw=0.6)
    _ticks(axes, factor * np.unique(errors[over]))


def _draw_noise(axes: Axes, table: pd.DataFrame) -> None:
    """Noise floor of the curves, where there are repeats."""
    floor = table.loc[table["quantity"] == "noise_floor", "value"]
    if len(floor):
        axes.axhspan(
            -floor.mean(), floor.mean(), color=NOISE_COLOUR, alpha=NOISE_OPACITY, lw=0, label="noise floor"
        )


def _draw_dispersion(axes: Axes, table: pd.DataFrame) -> None:
    """Spreading along x over the lag: of the particles, and of what the chain of each cell size learns."""
    by_lag = {
        name: rows.pivot(index="lag_s", columns="cell_m", values="value") * CM2
        for name, rows in table.groupby("quantity")
        if str(name).startswith("dispersion")
    }
    sizes = by_lag["dispersion"].columns
    axes.loglog(
        by_lag["dispersion"].index, by_lag["dispersion"].iloc[:, 0], color="black", lw=1.6, label="DEM"
    )
    for size, shade in zip(sizes, mpl.colormaps[SHADES](np.linspace(0.15, 0.85, len(sizes))), strict=True):
        theory = by_lag["dispersion"][size] + by_lag["dispersion_added"][size]
        axes.loglog(theory.index, theory, color=shade, lw=1.0, label=f"cells of {CM * size:.2g} cm")
        counted = by_lag["dispersion_of_cells"][size]
        axes.loglog(counted.index, counted, "o", ms=3, color=shade)
    axes.set(xlabel="lag [s]", ylabel=r"dispersion along x [cm$^2$/s]")
    axes.set_ylim(bottom=LEGEND_ROOM * axes.get_ylim()[0])
    axes.set_title("lines: theory, marks: counted", loc="left")
    axes.legend(fontsize=6, ncols=2, loc="lower center", columnspacing=1.0)
    _ticks(axes, by_lag["dispersion"].index.to_numpy())
    axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_locator(NullLocator())


def _ticks(axes: Axes, places: np.ndarray) -> None:
    """Ticks of a logarithmic axis at what was run."""
    axes.set_xticks(places, [f"{place:.2g}" for place in places], minor=False, fontsize=6)
    axes.xaxis.set_minor_locator(NullLocator())


if rule := globals().get("snakemake"):
    run_stage(plot_discussion, rule)
