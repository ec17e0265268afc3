# SPDX-License-Identifier: GPL-3.0-or-later
"""What accuracy costs with chains: error in noise floors over cost, and over each setting alone."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.ticker import NullFormatter, NullLocator

from bedchain.errors import UserError
from bedchain.figures import DOUBLE_COLUMN_IN, figure_style, save_figure
from bedchain.stage import stage, write_csv

FACTORIAL, ORDER = "cells and lag", "order"
# drawn as points over one column, each axis with the case's own setting
LINES = {"window": "length of the learning window [s]", "tracers": "tracers of a Monte Carlo [1]"}
POINTS = ("cell shape", "estimator", "window start", ORDER)
OBSERVABLES = {"mixing": ("mixing curves", "#222222", "o"), "density": ("density", "#4477aa", "s")}
SHADES, FRONT_COLOUR, PRESET_COLOUR = "viridis", "#bb5566", "#bb5566"
MM = 1e3


def plot_tradeoff(tradeoff: Path, png: Path, pdf: Path, csv: Path, resolution_dpi: int) -> None:
    """Draw the Pareto front of all cells and lags, their errors as a map, and what else was varied.

    Parameters
    ----------
    tradeoff : Path
        ``tradeoff.csv``.
    png, pdf, csv : Path
        Figure in two forms, and the numbers behind it.
    resolution_dpi : int
        Of the png [dots per inch].

    Raises
    ------
    UserError
        The table has no chain that went well.
    """
    table = shown_rows(pd.read_csv(tradeoff, dtype={"problem": str, "preset": str}))
    if table.empty:
        raise UserError(f"{tradeoff} holds no chain that went well; delete it and run again")
    unit = "noise floors" if table["unit"].iloc[0] == "floors" else "1"
    with figure_style():
        figure, panels = plt.subplots(2, 3, figsize=(DOUBLE_COLUMN_IN, 5.0))
        factorial = table[table["axis"] == FACTORIAL]
        _draw_front(panels[0, 0], table[table["axis"].isin((FACTORIAL, ORDER))], unit)
        for axes, name in zip(panels[0, 1:], OBSERVABLES, strict=True):
            _draw_map(axes, factorial, name, unit)
        own = factorial[factorial["own"] == 1]
        for axes, (axis, label) in zip(panels[1], LINES.items(), strict=False):
            _draw_line(axes, table[table["axis"] == axis], own, axis, label, unit)
        _draw_points(panels[1, 2], pd.concat([own, table[table["axis"].isin(POINTS)]]), unit)
        save_figure(figure, png, pdf, resolution_dpi)
    write_csv(table, csv)


def shown_rows(table: pd.DataFrame) -> pd.DataFrame:
    """Rows of the chains with the errors that are drawn.

    Returns
    -------
    DataFrame
        The setting's columns, cost_s, preset, own (1 for the case's own chain), and of each of
        `OBSERVABLES` ``<name>_1`` with its interval, in the unit of the column ``unit``: noise floors, or
        the share itself where there are none.
    """
    chains = table[(table["half"] == "mcm") & table["problem"].isna() & table["cost_s"].notna()].copy()
    in_floors = bool(chains["mixing_floors_1"].notna().all())
    for name in OBSERVABLES:
        error, floors = chains[f"{name}_error_1"], chains[f"{name}_floors_1"]
        scale = floors / error if in_floors else pd.Series(1.0, chains.index)
        for end in ("error", "ci_low", "ci_high"):
            chains[f"{name}_{end}"] = chains[f"{name}_{end}_1"] * scale
    chains["unit"] = "floors" if in_floors else "1"
    # the first row that was varied in nothing: the estimator, order and tracers of the others tell
    keys = ["model", "estimator", "cell_width_m", "cell_height_m", "lag_s", "learning_start_s"]
    alone = chains[chains["axis"] == "tracers"]
    own = alone[keys].iloc[:1] if len(alone) else chains[keys].iloc[:0]
    chains["own"] = chains[keys].apply(tuple, axis=1).isin(own.apply(tuple, axis=1)).astype(int)
    chains.loc[(chains["axis"] != FACTORIAL), "own"] = 0
    chains["label"] = [_label(row) for row in chains.to_dict("records")]
    wanted = [
        "axis",
        "label",
        *keys,
        "learning_end_s",
        "tracers",
        "cost_s",
        "memory_mb",
        "preset",
        "own",
        "unit",
    ]
    ends = [f"{name}_{end}" for name in OBSERVABLES for end in ("error", "ci_low", "ci_high")]
    return chains[[*wanted, *ends, "validation_error_1"]].reset_index(drop=True)


def _label(row: dict[str, object]) -> str:
    wide, high = (MM * float(str(row[f"cell_{side}_m"])) for side in ("width", "height"))
    return {
        "cell shape": f"cells {wide:.3g} x {high:.3g} mm",
        "estimator": f"estimator {row['estimator']}",
        "window start": f"learned {row['learning_start_s']:g}-{row['learning_end_s']:g} s",
        ORDER: f"{row['model']} {wide:.3g} mm, {row['lag_s']:g} s",
    }.get(str(row["axis"]), "the case's own")


def _draw_front(axes: Axes, table: pd.DataFrame, unit: str) -> None:
    """Error over cost: a line for each cell size, along the lags; the front, and the presets on it."""
    static = table[table["model"] == "static"]
    sizes = sorted(static["cell_height_m"].unique())
    for size, shade in zip(sizes, mpl.colormaps[SHADES](np.linspace(0.0, 0.9, len(sizes))), strict=True):
        rows = static[static["cell_height_m"] == size].sort_values("lag_s")
        axes.plot(
            rows["cost_s"], rows["mixing_error"], "o-", ms=3, lw=0.7, color=shade, label=f"{MM * size:.3g} mm"
        )
    other = table[table["model"] != "static"]
    axes.plot(
        other["cost_s"], other["mixing_error"], "^", ms=4, color="#222222", mfc="white", label="dynamic"
    )
    rising = table.sort_values("cost_s")
    axes.step(
        rising["cost_s"], rising["mixing_error"].cummin(), where="post", color=FRONT_COLOUR, lw=1.0,
        ls=(0, (4, 1.5)), label="front",
    )  # fmt: skip
    for row in table[table["preset"].notna()].itertuples():
        axes.plot(row.cost_s, row.mixing_error, "o", ms=8, mfc="none", mec=PRESET_COLOUR, mew=1.2)
        axes.annotate(
            str(row.preset).replace(" ", ",\n"), (row.cost_s, row.mixing_error), xytext=(6, 6),
            textcoords="offset points", color=PRESET_COLOUR, fontsize=7,
        )  # fmt: skip
    axes.set(xscale="log", xlabel="time to learn and to run [s]", ylabel=f"error of mixing [{unit}]")
    axes.set_ylim(bottom=0)
    axes.set_title("cells and lags", loc="left")
    axes.legend(
        fontsize=6, ncols=2, columnspacing=0.8, handlelength=1.4, title="cell height", title_fontsize=6
    )


def _draw_map(axes: Axes, table: pd.DataFrame, name: str, unit: str) -> None:
    """Error of every cell size with every lag, as numbers on colours."""
    values = table.pivot_table(f"{name}_error", "cell_height_m", "lag_s", "first")
    axes.imshow(values, origin="lower", aspect="auto", cmap="YlOrBr", norm=mpl.colors.LogNorm())
    bright = np.log(values.to_numpy())
    middle = 0.5 * (np.nanmin(bright) + np.nanmax(bright))
    for (row, column), value in np.ndenumerate(values.to_numpy()):
        if np.isfinite(value):
            colour = "white" if np.log(value) > middle + 0.25 * np.nanmax(bright - middle) else "black"
            axes.text(column, row, f"{value:.2g}", ha="center", va="center", fontsize=6, color=colour)
    axes.set_xticks(range(values.shape[1]), [f"{lag:g}" for lag in values.columns], fontsize=6)
    axes.set_yticks(range(values.shape[0]), [f"{MM * size:.3g}" for size in values.index], fontsize=6)
    axes.set(xlabel="lag [s]", ylabel="cell height [mm]")
    axes.set_title(f"{OBSERVABLES[name][0]} [{unit}]", loc="left")


def _draw_line(axes: Axes, table: pd.DataFrame, own: pd.DataFrame, axis: str, label: str, unit: str) -> None:
    """Error over one number, beside the case's own."""
    if axis == "window":
        table = pd.concat([table, own])
    over = table["tracers"] if axis == "tracers" else table["learning_end_s"] - table["learning_start_s"]
    table = table.assign(over=over).sort_values("over")
    for name, (title, colour, marker) in OBSERVABLES.items():
        _with_bars(axes, table["over"].to_numpy(), table, name, colour, marker, "-", title)
        if axis == "tracers" and len(own):
            axes.axhline(
                own[f"{name}_error"].iloc[0], color=colour, lw=0.8, ls=(0, (4, 1.5)), label=f"{title}, exact"
            )
    axes.set(xscale="log", xlabel=label, ylabel=f"error [{unit}]")
    if axis == "window":
        axes.set_xticks(table["over"].unique(), [f"{value:g}" for value in table["over"].unique()])
        axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_ylim(bottom=0)
    axes.legend(fontsize=6)


def _draw_points(axes: Axes, table: pd.DataFrame, unit: str) -> None:
    """One line a setting, errors as points."""
    places = np.arange(len(table))[::-1]
    for name, (_, colour, marker) in OBSERVABLES.items():
        values = table[f"{name}_error"]
        axes.hlines(places, table[f"{name}_ci_low"], table[f"{name}_ci_high"], color=colour, lw=0.8)
        axes.plot(values, places, marker, ms=3.5, color=colour, ls="none")
    axes.set_yticks(places, table["label"], fontsize=6)
    axes.set(xlabel=f"error [{unit}]")
    axes.set_xlim(left=0)
    axes.grid(axis="y", color="#e2e2e2", linewidth=0.5)
    axes.set_axisbelow(True)


def _with_bars(
    axes: Axes,
    over: np.ndarray,
    table: pd.DataFrame,
    name: str,
    colour: str,
    marker: str,
    line: str,
    label: str,
) -> None:
    axes.plot(over, table[f"{name}_error"], marker + line, ms=3.5, lw=0.9, color=colour, label=label)
    axes.vlines(over, table[f"{name}_ci_low"], table[f"{name}_ci_high"], color=colour, lw=0.8)


if "snakemake" in globals():
    with stage(snakemake.log[0]):
        plot_tradeoff(
            Path(snakemake.input.tradeoff),
            Path(snakemake.output.png),
            Path(snakemake.output.pdf),
            Path(snakemake.output.csv),
            snakemake.params.resolution_dpi,
        )
