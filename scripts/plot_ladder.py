# SPDX-License-Identifier: GPL-3.0-or-later
"""The ladder of models: error of each quantity over the cost of a simulated second."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style, footnote, label_parts
from bedchain.files import write_csv
from bedchain.stage import run_stage
from bedchain.studies.ladder.answers import QUANTITIES

COLUMNS = 5
# families by colour, members by marker
FAMILIES = {
    "bedFoam": "#222222",
    "two-fluid": "#aa3377",
    "static": "#ee6677",
    "dynamic": "#ccbb44",
    "velocity class": "#228833",
    "jump": "#66ccee",
    "recurrence": "#4477aa",
    "axial wakes": "#ee7733",
    "two-phase": "#997700",
    "plug flow": "#888888",
}
OTHER = "#cc3311"  # models that ran elsewhere
MARKERS = "osD^vP"
LEAST_ERROR, MOST_ERROR, LEAST_COST_S = 0.1, 60.0, 1e-5  # beyond, a mark stands at the edge
NOTE = """Error in noise floors: the dotted line is what another realisation of the simulation (mixing) or
another window of it (the others) differs by. Cost: processor time of one core for a simulated second, chains
without learning. A model without a mark cannot say that quantity. Marks at an edge are at it or beyond."""


def plot_ladder(ladder: Path, files: FigureFiles) -> None:
    """Draw ladder.csv, a panel for each quantity.

    Parameters
    ----------
    ladder : Path
    files : FigureFiles
    """
    table = pd.read_csv(ladder)
    shown = table[table["error_floors"].notna()]
    quantities = [name for name in QUANTITIES if (shown["quantity"] == name).any()]
    models = list(dict.fromkeys(shown["model"]))
    rows = -(-len(quantities) // COLUMNS)
    with figure_style():
        size = DOUBLE_COLUMN_IN, 1.75 * rows + 1.3
        figure, panels = plt.subplots(rows, COLUMNS, figsize=size, sharex=True, sharey=True, squeeze=False)
        for axes, name in zip(panels.flat, quantities, strict=False):
            draw(axes, shown[shown["quantity"] == name], models)
            axes.set_title(QUANTITIES[name].title, loc="left")
        for axes in panels.flat[len(quantities) :]:
            axes.set_visible(False)
        for axes in panels[:, 0]:
            axes.set_ylabel("error [noise floors]")
        for axes in panels[-1]:
            axes.set_xlabel("cost [s a simulated s]")
        handles, labels = panels.flat[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper center", ncols=4)
        footnote(figure, NOTE)
        files.save(figure)
    write_csv(shown, files.csv)


def draw(axes: Axes, rows: pd.DataFrame, models: list[str]) -> None:
    """Marks of one quantity; every model has an entry in the legend."""
    axes.axhline(1, color="#999999", lw=0.7, ls=":", zorder=0)
    for model in models:
        row = rows[rows["model"] == model]
        colour, marker = style_of(model, models)
        cost_s = row["cost_s_per_s"].clip(lower=LEAST_COST_S)
        error = row["error_floors"].clip(LEAST_ERROR, 0.9 * MOST_ERROR)
        axes.plot(
            cost_s, error, marker, color=colour, ms=5, mec="white", mew=0.4, ls="none", label=model,
        )  # fmt: skip
    axes.set(xscale="log", yscale="log", xlim=(LEAST_COST_S / 2, 3e3), ylim=(LEAST_ERROR / 1.2, MOST_ERROR))
    axes.set_xticks(10.0 ** np.arange(-4, 4, 2))
    label_parts(axes.yaxis, (1, 3))


def style_of(model: str, models: list[str]) -> tuple[str, str]:
    """Colour of a model's family, and its marker within it."""
    family = next((name for name in FAMILIES if model.startswith(name)), "")
    members = [other for other in models if other.startswith(family) and (family or not known(other))]
    return FAMILIES.get(family, OTHER), MARKERS[members.index(model) % len(MARKERS)]


def known(model: str) -> bool:
    """Whether a model belongs to a family."""
    return model.startswith(tuple(FAMILIES))


if rule := globals().get("snakemake"):
    run_stage(plot_ladder, rule)
