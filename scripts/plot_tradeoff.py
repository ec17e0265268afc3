# SPDX-License-Identifier: GPL-3.0-or-later
"""Trade-off of the chains: error in noise floors over cost, and over each setting alone."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.ticker import NullFormatter

from bedchain.errors import UserError, make_again
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style, label_parts
from bedchain.files import write_csv
from bedchain.stage import run_stage

FACTORIAL, ORDER = "cells and lag", "order"
POINTS = ("window", "window start", "cell shape", "estimator", ORDER)
OBSERVABLES = {"mixing": ("mixing curves", "#222222", "o"), "density": ("density", "#4477aa", "s")}
SHADES, FRONT_COLOUR = "viridis", "#bb5566"
# places of the names of the presets beside their rings, in points: below or above, left or right
NAME_PLACES = {"fast": (-4, -16), "balanced": (2, 12), "accurate": (8, -12)}
MM = 1e3


def plot_tradeoff(tradeoff: Path, files: FigureFiles) -> None:
    """Draw the Pareto front of all cells and lags, their errors as a map, and what else was varied.

    Parameters
    ----------
    tradeoff : Path
        ``tradeoff.csv``.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.

    Raises
    ------
    UserError
        The table has no chain that went well.
    """
    table = shown_rows(pd.read_csv(tradeoff, dtype={"problem": str, "preset": str}))
    if table.empty:
        raise UserError(f"{tradeoff} holds no chain that went well; {make_again(tradeoff)}")
    unit = "noise floors" if table["unit"].iloc[0] == "floors" else "1"
    with figure_style():
        figure, panels = plt.subplots(2, 3, figsize=(DOUBLE_COLUMN_IN, 5.4))
        factorial = table[table["axis"] == FACTORIAL]
        priced = table[table["axis"].isin((FACTORIAL, ORDER))]
        _draw_front(panels[0, 0], priced, "validation", "validation, which decides", unit)
        _draw_front(panels[1, 0], priced, "mixing_error", "mixing curves, tested", unit)
        for axes, name in zip(panels[0, 1:], OBSERVABLES, strict=True):
            _draw_map(axes, factorial, name, unit)
        own = factorial[factorial["own"] == 1]
        _draw_tracers(panels[1, 1], table[table["axis"] == "tracers"], own, unit)
        _draw_points(panels[1, 2], pd.concat([own, *(table[table["axis"] == axis] for axis in POINTS)]), unit)
        handles, names = panels[0, 0].get_legend_handles_labels()
        figure.legend(handles, names, loc="outside upper center", ncols=7, fontsize=6, handlelength=1.6)
        files.save(figure)
    write_csv(table, files.csv)


def shown_rows(table: pd.DataFrame) -> pd.DataFrame:
    """Rows of the chains with the errors that are drawn.

    Returns
    -------
    DataFrame
        The setting's columns, cost_s, preset, own (1 for the case's own chain), and the errors of validation
        and of each of `OBSERVABLES`, in the unit of the column ``unit``: noise floors (of the test), or the
        share itself where there are none.
    """
    chains = table[(table["half"] == "mcm") & table["problem"].isna() & table["cost_s"].notna()].copy()
    in_floors = bool(chains["mixing_floors_1"].notna().all())
    for name in OBSERVABLES:
        error, floors = chains[f"{name}_error_1"], chains[f"{name}_floors_1"]
        scale = floors / error if in_floors else pd.Series(1.0, chains.index)
        for end in ("error", "ci_low", "ci_high"):
            chains[f"{name}_{end}"] = chains[f"{name}_{end}_1"] * scale
    floor = chains["mixing_error_1"] / chains["mixing_floors_1"] if in_floors else 1.0
    chains["validation"] = chains["validation_error_1"] / floor
    chains["unit"] = "floors" if in_floors else "share"
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
    return chains[[*wanted, "validation", *ends]].reset_index(drop=True)


def _label(row: dict[str, object]) -> str:
    wide, high = (MM * float(str(row[f"cell_{side}_m"])) for side in ("width", "height"))
    learned = f"learned {row['learning_start_s']:g}-{row['learning_end_s']:g} s"
    return {
        "cell shape": f"cells {wide:.3g} x {high:.3g} mm",
        "estimator": f"estimator {row['estimator']}",
        "window": learned,
        "window start": learned,
        ORDER: f"{row['model']} {wide:.3g} mm, {row['lag_s']:g} s",
    }.get(str(row["axis"]), "the case's own")


def _sizes(table: pd.DataFrame) -> list[tuple[float, float]]:
    """Width and height of the cells, smallest first."""
    sizes = set(zip(table["cell_width_m"], table["cell_height_m"], strict=True))
    return sorted(sizes, key=lambda size: size[0] * size[1])


def _size_label(size: tuple[float, float]) -> str:
    return " x ".join(f"{MM * side:.3g}" for side in size)


def _draw_front(axes: Axes, table: pd.DataFrame, name: str, title: str, unit: str) -> None:
    """Error over cost: a line for each cell size, along the lags; the front, and the presets."""
    table = table[table[name].notna()]
    static = table[table["model"] == "static"]
    sizes = _sizes(static)
    for size, shade in zip(sizes, mpl.colormaps[SHADES](np.linspace(0.0, 0.9, len(sizes))), strict=True):
        rows = static[(static["cell_width_m"] == size[0]) & (static["cell_height_m"] == size[1])]
        rows = rows.sort_values("lag_s")
        axes.plot(
            rows["cost_s"], rows[name], "o-", ms=3, lw=0.7, color=shade, label=f"{_size_label(size)} mm"
        )
    other = table[table["model"] != "static"]
    axes.plot(other["cost_s"], other[name], "^", ms=4, color="#222222", mfc="white", label="dynamic")
    rising = table.sort_values("cost_s")
    lowest = rising[name].cummin()
    axes.step(
        [*rising["cost_s"], axes.get_xlim()[1]], [*lowest, *lowest.iloc[-1:]], where="post",
        color=FRONT_COLOUR, lw=1.0, ls=(0, (4, 1.5)), label="front",
    )  # fmt: skip
    for row in table[table["preset"].notna()].to_dict("records"):
        names = str(row["preset"]).split()
        axes.plot(row["cost_s"], row[name], "o", ms=8, mfc="none", mec=FRONT_COLOUR, mew=1.2)
        axes.annotate(
            ", ".join(names), (row["cost_s"], row[name]), xytext=NAME_PLACES[names[0]], fontsize=7,
            textcoords="offset points", color=FRONT_COLOUR,
        )  # fmt: skip
    axes.set(xscale="log", yscale="log", xlabel="time to learn and to run [s]", ylabel=f"error [{unit}]")
    label_parts(axes.xaxis, (1, 3))
    label_parts(axes.yaxis, (1, 1.5, 2, 3, 5))
    low, high = axes.get_ylim()
    axes.set_ylim(low / 1.15, high)
    axes.set_title(title, loc="left")


def _draw_map(axes: Axes, table: pd.DataFrame, name: str, unit: str) -> None:
    """Error of every cell size with every lag, as numbers on colours."""
    sizes = _sizes(table)
    values = table.pivot(index=["cell_width_m", "cell_height_m"], columns="lag_s", values=f"{name}_error")
    values = values.loc[sizes]
    axes.imshow(values, origin="lower", aspect="auto", cmap="YlOrBr", norm=mpl.colors.LogNorm())
    bright = np.log(values.to_numpy())
    dark = 0.3 * np.nanmin(bright) + 0.7 * np.nanmax(bright)
    for (row, column), value in np.ndenumerate(values.to_numpy()):
        if np.isfinite(value):
            colour = "white" if np.log(value) > dark else "black"
            axes.text(column, row, f"{value:.2g}", ha="center", va="center", fontsize=6, color=colour)
    axes.set_xticks(range(values.shape[1]), [f"{lag:g}" for lag in values.columns], fontsize=6)
    axes.set_yticks(range(values.shape[0]), [_size_label(size) for size in sizes], fontsize=6)
    axes.set(xlabel="lag [s]", ylabel="cells [mm]")
    axes.set_title(f"{OBSERVABLES[name][0]} [{unit}]", loc="left")


def _draw_tracers(axes: Axes, table: pd.DataFrame, own: pd.DataFrame, unit: str) -> None:
    """Error of a Monte Carlo over its tracers, beside that of the exact chain."""
    for name, (title, colour, marker) in OBSERVABLES.items():
        over, error = table["tracers"], table[f"{name}_error"]
        axes.plot(over, error, f"{marker}-", ms=3.5, lw=0.9, color=colour, label=title)
        axes.vlines(over, table[f"{name}_ci_low"], table[f"{name}_ci_high"], color=colour, lw=0.8)
        for exact in own[f"{name}_error"]:
            axes.axhline(exact, color=colour, lw=0.8, ls=(0, (4, 1.5)), label=f"{title}, exact")
    axes.set(xscale="log", xlabel="tracers of a Monte Carlo [1]", ylabel=f"error [{unit}]")
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


if rule := globals().get("snakemake"):
    run_stage(plot_tradeoff, rule)
