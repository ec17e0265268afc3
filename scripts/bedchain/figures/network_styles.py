# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours and panels of the figures of networks, told apart by colour-blind readers."""

from collections.abc import Iterable

import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bedchain.figures.style import DOUBLE_COLUMN_IN

# the qualitative colours of P. Tol
COLOURS = ("#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377", "#222222", "#bbbbbb")
DASHES: tuple = ("-", (0, (4, 1.5)), (0, (1, 1)), (0, (4, 1, 1, 1)))
PANELS_ACROSS, PANEL_HEIGHT_IN, LEGEND_ACROSS = 4, 2.2, 6


def colours_of(names: Iterable[str]) -> dict[str, str]:
    """Colour of each name, in the order of their first appearance."""
    return {name: COLOURS[place % len(COLOURS)] for place, name in enumerate(dict.fromkeys(names))}


def panels_of(names: list[str]) -> tuple[Figure, list[Axes]]:
    """A figure with a panel for each name, in rows of at most four; names are the panels' titles."""
    across = min(PANELS_ACROSS, len(names))
    down = -(-len(names) // across)
    size = (DOUBLE_COLUMN_IN if across > 1 else DOUBLE_COLUMN_IN / 2, PANEL_HEIGHT_IN * down + 0.3)
    figure, grid = plt.subplots(down, across, figsize=size, squeeze=False)
    panels = list(grid.flat)
    for spare in panels[len(names) :]:
        spare.set_visible(False)
    for axes, name in zip(panels, names, strict=False):
        axes.set_title(name, loc="left", fontsize=7)
    return figure, panels[: len(names)]


def figure_legend(figure: Figure, panels: list[Axes], **options: float) -> None:
    """One legend below all panels; none where nothing has a label."""
    shown = {
        label: handle
        for axes in panels
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    if shown:
        across = min(len(shown), LEGEND_ACROSS)
        figure.legend(list(shown.values()), list(shown), loc="outside lower center", ncols=across, **options)


def with_text(table: pd.DataFrame, *columns: str) -> pd.DataFrame:
    """A table whose empty texts are empty texts, not numbers."""
    return table.assign(**{name: table[name].astype(object).fillna("").astype(str) for name in columns})
