# SPDX-License-Identifier: GPL-3.0-or-later
"""Residence times of an open bed: F and E over the time after entering, of the DEM and of the chain."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt

from bedchain.errors import UserError
from bedchain.figures.style import DOUBLE_COLUMN_IN, LINE_COLOUR, FigureFiles, figure_style
from bedchain.files import write_csv
from bedchain.stage import run_stage

PANELS = {
    "left_share": "F: share that has left [1]",
    "leaving_rate": "E: share that leaves [1/s]",
}
DASHES = {"dem": "-", "chain": (0, (4, 1.5))}
NAMES = {"dem": "DEM", "chain": "chain"}


def plot_residence(residence: Path, files: FigureFiles, colours: dict[str, str]) -> None:
    """Draw both distributions with their bands, and the mean beside contents over throughput.

    Parameters
    ----------
    residence : Path
        ``residence.csv`` of measure_residence.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    colours : dict of str to str
        Of dem and chain.

    Raises
    ------
    UserError
        The table lacks the DEM or the chain.
    """
    table = pd.read_csv(residence)
    if not set(colours) <= set(table["source"]):
        raise UserError(f"{residence} lacks the residence times of {', '.join(colours)}: make it again")
    with figure_style():
        figure, panels = plt.subplots(1, 2, figsize=(DOUBLE_COLUMN_IN, 2.6))
        for axes, (quantity, label) in zip(panels, PANELS.items(), strict=True):
            for source, colour in colours.items():
                part = table[(table["quantity"] == quantity) & (table["source"] == source)].dropna(
                    subset="value"
                )
                axes.fill_between(
                    part["time_s"], part["ci_low"], part["ci_high"], color=colour, alpha=0.2, lw=0
                )
                axes.plot(part["time_s"], part["value"], color=colour, ls=DASHES[source], label=NAMES[source])
            axes.set(xlabel="time after entering [s]", ylabel=label, xlim=(0, None), ylim=(0, None))
        for source, colour in colours.items():
            panels[0].axvline(number(table, source, "mean"), color=colour, ls=DASHES[source], lw=0.6)
        note = "\n".join(caption(table, source) for source in colours)
        panels[0].set_title(note, fontsize=6.5, color=LINE_COLOUR, loc="left")
        panels[1].legend(title="with 95 % bands", title_fontsize=7)
        files.save(figure)
    write_csv(table, files.csv)


def number(table: pd.DataFrame, source: str, quantity: str, column: str = "value") -> float:
    """A number of a source that has no time."""
    rows = table[(table["quantity"] == quantity) & (table["source"] == source)]
    return float(rows[column].iloc[0]) if len(rows) else float("nan")


def caption(table: pd.DataFrame, source: str) -> str:
    """Mean residence time and contents over throughput of a source, with half their bands."""
    words = []
    for quantity, name in (("mean", "mean"), ("contents_over_throughput", "contents/throughput")):
        value = number(table, source, quantity)
        ends = [number(table, source, quantity, end) for end in ("ci_low", "ci_high")]
        words.append(f"{name} {value:.3g} s ({ends[0]:.3g} to {ends[1]:.3g})")
    return f"{NAMES[source]}: " + ", ".join(
        words if np.isfinite(number(table, source, "mean")) else words[1:]
    )


if rule := globals().get("snakemake"):
    run_stage(plot_residence, rule)
