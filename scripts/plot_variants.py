# SPDX-License-Identifier: GPL-3.0-or-later
"""Change and cost of each choice in simulating a bed, the change in noise floors."""

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

from bedchain.errors import UserError
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style, label_parts
from bedchain.files import write_csv
from bedchain.stage import run_stage
from bedchain.studies.pareto import pareto_front

# heads of the columns; the first two have no sign
TITLES = {
    "mixing": "mixing\ncurves",
    "density": "density",
    "mixing_time_radial": "mixing\ntime,\nradial",
    "mixing_time_axial": "mixing\ntime,\naxial",
    "bed_height": "bed\nheight",
    "pressure_drop": "pressure\ndrop",
    "pressure_drop_spread": "its\nspread",
    "dispersion_x": "dispersion\nx",
    "dispersion_z": "dispersion\nz",
    "granular_temperature": "granular\ntemperature",
}
COLOURS, COST_COLOUR, LINE_IN = "RdBu_r", "#4477aa", 0.19
FRONT_IN, FRONT_COLOUR = 3.2, "#bb5566"
# the same bed: its own line of the table, and others from another random start
REALISATION = "realisation"
NEAR_COST = 1.15
# colours end here, numbers do not
MOST_FLOORS = 15.0
REASON_LETTERS = 110


def plot_variants(tradeoff: Path, files: FigureFiles) -> None:
    """Draw one line a variant: its change of each observable, and its cost over that of the bed itself.

    Parameters
    ----------
    tradeoff : Path
        ``tradeoff.csv``.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.

    Raises
    ------
    UserError
        No bed was simulated.
    """
    table = shown_rows(pd.read_csv(tradeoff, dtype={"problem": str}))
    if table.empty:
        raise UserError(f"{tradeoff} holds no simulated bed: take --config tradeoff='{{dem: all}}'")
    with figure_style():
        lines_in = 1.2 + LINE_IN * len(table)
        figure = plt.figure(figsize=(DOUBLE_COLUMN_IN, lines_in + FRONT_IN))
        parts: Any = figure.subfigures(2, 1, height_ratios=[lines_in, FRONT_IN])
        upper, lower = parts
        axes, costs = upper.subplots(1, 2, width_ratios=[5, 1], sharey=True)
        _draw_changes(axes, table)
        _draw_costs(costs, table)
        _draw_front(lower.subplots(), table)
        files.save(figure)
    write_csv(table, files.csv)


def shown_rows(table: pd.DataFrame) -> pd.DataFrame:
    """Variants by axis, with the changes that are drawn.

    Returns
    -------
    DataFrame
        axis, variant, changed, problem, cost_s, cost_over_base_1 (base: the median of its own realisations),
        the observables of `TITLES` and the largest change of them in noise floors, and whether nothing
        cheaper changes less (front, 0 or 1).
    """
    beds = table[table["half"] == "dem"]
    order = {
        axis: number for number, axis in enumerate(dict.fromkeys([REALISATION, *sorted(set(beds["axis"]))]))
    }
    beds = beds.assign(order=beds["axis"].map(order)).sort_values(["order", "variant"], kind="stable")
    base = beds.loc[beds["axis"] == REALISATION, "cost_s"].median()
    found = beds[["axis", "variant", "changed", "problem", "cost_s"]].copy()
    found["cost_over_base_1"] = beds["cost_s"] / base
    for name in TITLES:
        found[f"{name}_floors_1"] = beds[f"{name}_floors_1"]
    found["largest_floors_1"] = found[[f"{name}_floors_1" for name in TITLES]].abs().max(axis=1)
    found["front"] = found.index.isin(pareto_front(found, "cost_s", "largest_floors_1").index).astype(int)
    return found.reset_index(drop=True)


def _draw_changes(axes: Axes, table: pd.DataFrame) -> None:
    values = table[[f"{name}_floors_1" for name in TITLES]].to_numpy(float)
    norm = mpl.colors.Normalize(-MOST_FLOORS, MOST_FLOORS)
    axes.imshow(values, aspect="auto", cmap=COLOURS, norm=norm)
    for (row, column), value in np.ndenumerate(values):
        if np.isfinite(value):
            colour = "white" if abs(value) > 0.6 * MOST_FLOORS else "black"
            axes.text(column, row, f"{value:.1f}", ha="center", va="center", fontsize=6, color=colour)
    for row, problem in enumerate(table["problem"]):
        if isinstance(problem, str):
            said = " ".join(problem.split())[:REASON_LETTERS]
            axes.text(-0.4, row, said, va="center", fontsize=5, color="#882222", clip_on=True)
    axes.set_xticks(range(len(TITLES)), TITLES.values(), fontsize=6)
    axes.xaxis.tick_top()
    axes.set_yticks(range(len(table)), table["variant"].str.replace("_", " "), fontsize=6)
    axes.set_title("change in noise floors (the first two without a sign)", loc="left")
    for row in np.flatnonzero((table["axis"] != table["axis"].shift()).to_numpy())[1:]:
        axes.axhline(row - 0.5, color="black", lw=0.4)


def _draw_costs(axes: Axes, table: pd.DataFrame) -> None:
    known = table["cost_over_base_1"].notna().any()
    values = table["cost_over_base_1"] if known else table["cost_s"]
    axes.plot(values, table.index, "o", ms=4, color=COST_COLOUR)
    if known:
        axes.axvline(1.0, color="black", lw=0.6)
    axes.set(xscale="log", xlabel="cost over\nbase [1]" if known else "cost [s]")
    label_parts(axes.xaxis, (1, 2, 5, 7))
    axes.grid(axis="y", color="#e2e2e2", linewidth=0.5)
    axes.tick_params(labelleft=False)


def _draw_front(axes: Axes, table: pd.DataFrame) -> None:
    """The largest change of any observable over the cost, the front, and how far the same bed is."""
    known = table[table["largest_floors_1"].notna() & table["cost_over_base_1"].notna()]
    axes.plot(known["cost_over_base_1"], known["largest_floors_1"], "o", ms=4, color=COST_COLOUR)
    same = known[known["axis"] == REALISATION]
    axes.plot(same["cost_over_base_1"], same["largest_floors_1"], "s", ms=4, color="black")
    if len(same):
        axes.axhspan(0.0, same["largest_floors_1"].max(), color="#e8e8e8", zorder=0)
    front = known[known["front"] == 1].sort_values("cost_over_base_1")
    axes.step(
        front["cost_over_base_1"], front["largest_floors_1"], where="post", color=FRONT_COLOUR, lw=1.0,
        ls=(0, (4, 1.5)),
    )  # fmt: skip
    # those that the crowd would hide, as dear as the same bed and no further from it, have no name here
    near, least = known["cost_over_base_1"].between(1 / NEAR_COST, NEAR_COST), known["largest_floors_1"]
    crowd = near & (least <= same["largest_floors_1"].max()) & (known["front"] == 0)
    for number, row in enumerate(known[~crowd].sort_values("largest_floors_1").to_dict("records")):
        side = number % 2
        axes.annotate(
            str(row["variant"]).replace("_", " "), (row["cost_over_base_1"], row["largest_floors_1"]),
            xytext=(4 - 8 * side, 0), textcoords="offset points", fontsize=6, va="center",
            ha=("left", "right")[side],
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 0.6},
        )  # fmt: skip
    axes.set(xscale="log", yscale="log", xlabel="cost over base [1]", ylabel="largest change\n[noise floors]")
    label_parts(axes.xaxis, (1, 1.5, 2, 3, 5, 7))
    label_parts(axes.yaxis, (1, 2, 5))
    axes.set_title(
        "squares: the same bed, from other starts; dashed: nothing cheaper changes less", loc="left"
    )


if rule := globals().get("snakemake"):
    run_stage(plot_variants, rule)
