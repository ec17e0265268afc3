# SPDX-License-Identifier: GPL-3.0-or-later
"""Fig. 5 with the best model: DEM and its repeats, the paper's static chain, the model validation chose."""

from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

from bedchain.errors import UserError, make_again
from bedchain.figures.model_styles import BASELINE, label, model_styles
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style
from bedchain.files import write_csv
from bedchain.stage import run_stage

PANELS = {"left": "left half", "right": "right half", "low": "lower part", "up": "upper part"}
REPEAT, MONTE_CARLO = "dem_", "_monte_carlo"


def plot_best_mixing(
    mixing: Path, selection: Path, files: FigureFiles, dem_colour: str, static_colour: str
) -> None:
    """Draw the four groups, each with the DEM, the range of its repeats, and two chains.

    Parameters
    ----------
    mixing, selection : Path
        ``scores_mixing.csv`` and ``selection.csv``.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    dem_colour, static_colour : str
        Colours of the DEM and of the static chain.

    Raises
    ------
    UserError
        The curves of the best model are missing.
    """
    chosen = pd.read_csv(selection).query("best == 1")["model"].item()
    table = pd.read_csv(mixing)
    if not {"dem", BASELINE, chosen} <= {*table["source"]}:
        raise UserError(f"{mixing} lacks curves of dem, {BASELINE} or {chosen}; {make_again(mixing)}")
    repeats = table["source"].str.startswith(REPEAT)
    kept = table[table["source"].isin(["dem", BASELINE, chosen, f"{chosen}{MONTE_CARLO}"]) | repeats]
    with figure_style():
        figure, panels = plt.subplots(2, 2, figsize=(DOUBLE_COLUMN_IN, 4.6), sharex=True, sharey="row")
        for axes, (group, name) in zip(panels.flat, PANELS.items(), strict=True):
            _draw_group(axes, kept[kept["group"] == group], chosen, dem_colour, static_colour)
            axes.set_title(name, loc="left")
        for axes in panels[:, 0]:
            axes.set_ylabel("share still on its side [1]")
        for axes in panels[-1]:
            axes.set_xlabel("time [s]")
        panels[0, 0].set_xlim(kept["time_s"].min(), kept["time_s"].max())
        handles, labels = panels[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper center", ncols=5, handlelength=2.4)
        files.save(figure)
    write_csv(kept, files.csv)


def _draw_group(axes: Axes, table: pd.DataFrame, chosen: str, dem_colour: str, static_colour: str) -> None:
    style = model_styles([chosen])[chosen]
    curves = dict(iter(table.groupby("source", sort=False)))
    repeats = table[table["source"].str.startswith(REPEAT) | (table["source"] == "dem")]
    if repeats["source"].nunique() > 1:
        ends = repeats.groupby("time_s")["fraction_remaining_1"].agg(["min", "max"])
        number = repeats["source"].nunique()
        axes.fill_between(
            ends.index,
            ends["min"],
            ends["max"],
            color=dem_colour,
            alpha=0.15,
            lw=0,
            label=f"{number} DEM runs",
        )
    drawn: dict[str, dict[str, Any]] = {
        "dem": {"color": dem_colour, "lw": 1.6, "label": "DEM"},
        BASELINE: {"color": static_colour, "ls": (0, (4, 1.5)), "label": label(BASELINE)},
        chosen: {"color": style.colour, "lw": 1.6, "label": f"{label(chosen)} (best)"},
        f"{chosen}{MONTE_CARLO}": {
            "color": style.colour,
            "lw": 0.7,
            "alpha": 0.8,
            "label": "one Monte Carlo",
        },
    }
    for source, look in drawn.items():
        curve = curves[source]
        axes.plot(curve["time_s"], curve["fraction_remaining_1"], **look)
    axes.grid(axis="y", color="#e2e2e2", linewidth=0.5)
    axes.set_axisbelow(True)


if rule := globals().get("snakemake"):
    run_stage(plot_best_mixing, rule)
