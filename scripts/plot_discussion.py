# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of the chains by cell size and by lag, and the two effects behind them, as dispersion."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullLocator

from bedchain.errors import UserError, make_again
from bedchain.figures.model_styles import label
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style, footnote
from bedchain.files import write_csv
from bedchain.stage import run_stage

DIRECTIONS = {"radial": ("left and right", "-", "o"), "axial": ("low and up", (0, (4, 1.5)), "s")}
CM = 100.0
# the smallest, the case's own and the largest cells; Paul Tol's muted scheme, with a marker each
SIZE_STYLES = (("#332288", "o"), ("#117733", "s"), ("#cc6677", "^"))
# points of two chains beside each other, as a share of the axis value
SHIFT = 0.03
NOTE = """Left, middle: time mean of chain - mean of {runs} DEM runs over both groups of a direction;
{bars}. Right: what the chain's cells spread along x over what the particles do; marks counted, lines theory
(positions uniform in a cell), which is off by at most {off:.0f} %."""
BARS = "bars are 95 % intervals by the scatter of the runs, the same for all chains"
NO_BARS = "no bars, since one run shows no scatter"


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
    errors = table[(table["quantity"] == "error_signed") & table["part"].isin(DIRECTIONS)]
    own = {
        "cell_m": np.isclose(errors["cell_m"], own_cell_m),
        "lag_s": np.isclose(errors["lag_s"], own_lag_s),
    }
    if not (own["cell_m"] & own["lag_s"]).any():
        raise UserError(f"{discussion} is of other cells or another lag; {make_again(discussion)}")
    spread = relative_dispersion(table[table["part"] == "x"])
    with figure_style():
        figure, panels = plt.subplots(1, 3, figsize=(DOUBLE_COLUMN_IN, 3.4))
        panels[1].sharey(panels[0])  # before anything is drawn: both ask for room
        _draw_errors(panels[0], errors[own["lag_s"]], "cell_m", colours, CM)
        _draw_errors(panels[1], errors[own["cell_m"]], "lag_s", colours, 1.0)
        panels[0].set(xlabel="cell size [cm]", ylabel="error of the share on its side [1]")
        panels[0].set_title(f"lag {own_lag_s:g} s", loc="left")
        panels[1].set(xlabel="lag [s]")
        panels[1].set_title(f"cells of {CM * own_cell_m:.2g} cm", loc="left")
        _draw_dispersion(panels[2], spread, own_cell_m)
        handles, labels = panels[0].get_legend_handles_labels()
        figure.legend(
            handles, labels, loc="outside upper left", ncols=min(3, len(labels) // 2), handlelength=2.6
        )
        banded = errors["ci_low"].notna().any()
        off = 100 * (spread["theory"] / spread["counted"] - 1).abs().max()
        runs = int(table.loc[table["quantity"] == "realisations", "value"].sum())
        footnote(figure, NOTE.format(runs=runs, bars=BARS if banded else NO_BARS, off=off))
        files.save(figure)
    write_csv(table, files.csv)


def relative_dispersion(table: pd.DataFrame) -> pd.DataFrame:
    """Dispersion of a chain's cells over that of the particles.

    Parameters
    ----------
    table : DataFrame
        Of one axis: dispersion, dispersion_of_cells, dispersion_added by cell_m and lag_s [m2/s].

    Returns
    -------
    DataFrame
        cell_m, lag_s, counted, theory [1].
    """
    wide = table.pivot(index=["cell_m", "lag_s"], columns="quantity", values="value")
    counted = wide["dispersion_of_cells"] / wide["dispersion"]
    theory = 1 + wide["dispersion_added"] / wide["dispersion"]
    return pd.DataFrame({"counted": counted, "theory": theory}).reset_index()


def _draw_errors(axes: Axes, errors: pd.DataFrame, over: str, colours: dict[str, str], factor: float) -> None:
    """Mean error of both groups of a direction, for each model."""
    for place, (model, rows) in enumerate(errors.groupby("source", sort=False)):
        for direction, (name, dash, marker) in DIRECTIONS.items():
            part = rows[rows["part"] == direction].sort_values(over)
            at = factor * part[over] * (1 + SHIFT) ** (2 * place + (direction == "axial"))
            bars = np.nan_to_num(part["value"] - part["ci_low"])
            axes.errorbar(
                at, part["value"], bars, color=colours[str(model)], linestyle=dash, marker=marker, ms=3,
                elinewidth=0.7, label=f"{label(str(model))}, {name}",
            )  # fmt: skip
    axes.axhline(0, color="black", lw=0.6)
    axes.set_xscale("log")
    _ticks(axes, factor * np.unique(errors[over]))


def _draw_dispersion(axes: Axes, spread: pd.DataFrame, own_cell_m: float) -> None:
    """Spreading along x by the chain's cells over the particles' own, over the lag."""
    sizes = np.unique(spread["cell_m"])
    own = sizes[np.argmin(np.abs(sizes - own_cell_m))]
    for size, (colour, marker) in zip(sorted({sizes[0], own, sizes[-1]}), SIZE_STYLES, strict=False):
        rows = spread[spread["cell_m"] == size].sort_values("lag_s")
        axes.loglog(rows["lag_s"], rows["theory"], color=colour, lw=1.0)
        axes.loglog(rows["lag_s"], rows["counted"], color=colour, marker=marker, ls="none", ms=3.5,
                    label=f"cells of {CM * size:.2g} cm")  # fmt: skip
    axes.axhline(1, color="black", lw=0.6)
    axes.set(xlabel="lag [s]", ylabel="dispersion, cells over DEM [1]")
    axes.legend(loc="upper right")
    _ticks(axes, np.unique(spread["lag_s"]))
    axes.yaxis.set_major_locator(LogLocator(subs=(1, 1.5, 2, 3, 5)))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_locator(NullLocator())


def _ticks(axes: Axes, places: np.ndarray) -> None:
    """Ticks of a logarithmic axis at what was run."""
    axes.set_xticks(places, [f"{place:.2g}" for place in places], minor=False, fontsize=6)
    axes.xaxis.set_minor_locator(NullLocator())


if rule := globals().get("snakemake"):
    run_stage(plot_discussion, rule)
