# SPDX-License-Identifier: GPL-3.0-or-later
"""Contents of the states of a network in the steady state: by the chain and as declared."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from bedchain.figures.network_styles import colours_of, figure_legend, panels_of, with_text
from bedchain.figures.style import FigureFiles, figure_style
from bedchain.files import write_csv
from bedchain.stage import run_stage

# up to so many states without a height have their names at the axis
NAMED = 12
# rings at so many heights; a state with so many times the content of the others is shown on a logarithmic
# axis
RINGS, FAR = 12, 3


def plot_network_states(states: Path, files: FigureFiles) -> None:
    """Draw the contents over height, a colour a zone; of states without a height as bars.

    Parameters
    ----------
    states : Path
        ``states.csv`` of run_network.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    """
    table = with_text(pd.read_csv(states), "zone", "state")
    with figure_style():
        figure, panels = panels_of(list(dict.fromkeys(table["chain"])))
        for axes, (_, part) in zip(panels, table.groupby("chain", sort=False), strict=True):
            if part["height_m"].notna().all():
                over_height(axes, part, colours_of(table["zone"]))
            else:
                bars(axes, part)
        figure_legend(figure, panels)
        files.save(figure)
    write_csv(table, files.csv)


def over_height(axes: Axes, part: pd.DataFrame, colours: dict[str, str]) -> None:
    """Contents of a chain over the height of its states."""
    columns = [states["content"].max() for _, states in part.groupby("zone") if len(states) > 1]
    usual = max(columns, default=part["content"].max())
    for zone, states in part.groupby("zone", sort=False):
        alone = "D" if len(states) == 1 else ""
        axes.plot(
            states["content"], states["height_m"], color=colours[zone], marker=alone, ms=4, label=zone or None
        )
        rings = states.iloc[:: max(1, len(states) // RINGS)]
        axes.plot(rings["declared"], rings["height_m"], "o", mfc="none", color=colours[zone], ms=6, mew=0.6)
    axes.set(xlabel="content [declared unit]", ylabel="height [m]", ylim=(0, None))
    axes.locator_params(axis="x", nbins=4)
    if part["content"].max() > FAR * usual:
        axes.set_xscale("log")
    else:
        axes.set_xlim(0, 1.15 * part["content"].max())


def bars(axes: Axes, part: pd.DataFrame) -> None:
    """Contents of a chain by state."""
    places = np.arange(len(part))
    axes.barh(places, part["content"], color="#4477aa", height=0.7)
    axes.plot(part["declared"], places, "o", mfc="white", mec="#222222", ms=4)
    axes.set(xlabel="content [declared unit]", ylim=(len(part) - 0.4, -0.6))
    axes.set_yticks(places if len(part) <= NAMED else [])
    if len(part) <= NAMED:
        axes.set_yticklabels(part["state"])


if rule := globals().get("snakemake"):
    run_stage(plot_network_states, rule)
