# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of the checks: values of the solver as marks, the theory as lines."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.ticker import LogLocator, NullFormatter

from bedchain.figures.style import LINE_COLOUR, SINGLE_COLUMN_IN, figure_style, save_figure
from bedchain.files import write_csv

RESOLUTION_DPI = 200
DECADES_WITH_STEPS = 3  # a shorter logarithmic axis has numbers at 2 and 5 too
MARKS = 24  # at most on a curve
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00"]  # Okabe and Ito 2008
SHAPES = "osD^v"


@dataclass(frozen=True)
class Curve:
    """A quantity of the solver and its reference over the same axis.

    Attributes
    ----------
    name : str
        In the legend.
    x, value, reference : (n,) ndarray
        Axis, the solver's values, the theory's.
    """

    name: str
    x: np.ndarray
    value: np.ndarray
    reference: np.ndarray


def draw(
    stem: Path,
    curves: list[Curve],
    x_label: str,
    y_label: str,
    logarithmic: bool = False,
    line: str = "theory",
) -> None:
    """Draw curves and write ``stem`` .png, .pdf and the numbers as .csv.

    Parameters
    ----------
    stem : Path
        Without suffix.
    curves : list of Curve
    x_label, y_label : str
        With units in brackets.
    logarithmic : bool
        Both axes.
    line : str
        Name of the lines in the legend.
    """
    with figure_style():
        figure, axes = plt.subplots(figsize=(SINGLE_COLUMN_IN, 0.8 * SINGLE_COLUMN_IN))
        for curve, colour, shape in zip(curves, COLOURS, SHAPES, strict=False):
            order = np.argsort(curve.x) if logarithmic else np.arange(len(curve.x))
            axes.plot(curve.x[order], curve.reference[order], color=colour, linewidth=0.9, zorder=2)
            some = slice(None, None, max(1, len(curve.x) // MARKS))
            axes.plot(
                curve.x[some], curve.value[some], shape, color=colour, markersize=3.5,
                markerfacecolor="white", markeredgewidth=0.9, linestyle="none", label=curve.name, zorder=3,
            )  # fmt: skip
        axes.plot([], [], color=LINE_COLOUR, linewidth=0.9, label=line)
        if logarithmic:
            axes.loglog()
            for axis in (axes.xaxis, axes.yaxis):
                short = np.diff(np.log10(axis.get_view_interval()))[0] < DECADES_WITH_STEPS
                axis.set_major_locator(LogLocator(subs=(1, 2, 5) if short else (1,)))
                axis.set_major_formatter("{x:g}")
                axis.set_minor_formatter(NullFormatter())
        else:
            axes.locator_params(axis="x", nbins=6)
        axes.set_xlabel(x_label)
        axes.set_ylabel(y_label)
        axes.legend()
        save_figure(figure, stem.with_suffix(".png"), stem.with_suffix(".pdf"), RESOLUTION_DPI)
    columns = [
        pd.DataFrame({"curve": curve.name, "x": curve.x, "solver": curve.value, "theory": curve.reference})
        for curve in curves
    ]
    write_csv(pd.concat(columns), stem.with_suffix(".csv"))
