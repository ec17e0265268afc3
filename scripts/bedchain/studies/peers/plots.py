# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure of the comparison: wall time per simulated second of each code, with a mark for each bed."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt

from bedchain.figures.style import DOUBLE_COLUMN_IN, figure_style, save_figure

RESOLUTION_DPI = 200
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7"]  # Okabe and Ito 2008
SHAPES = "osD^"


def draw(table: pd.DataFrame, stem: Path) -> None:
    """Draw the medians with their ranges, and write ``stem`` .png and .pdf.

    Parameters
    ----------
    table : DataFrame
        Of `table.summary`.
    stem : Path
        Without suffix.
    """
    done = table[table["repeats"] > 0]
    codes = list(dict.fromkeys(done["code"]))[::-1]
    with figure_style():
        figure, axes = plt.subplots(figsize=(DOUBLE_COLUMN_IN / 1.4, 0.32 * len(codes) + 1))
        for (name, of_bed), colour, shape in zip(
            done.groupby("bed", sort=False), COLOURS, SHAPES, strict=False
        ):
            middle = of_bed["wall_s_per_simulated_s"].to_numpy()
            ends = of_bed[["fastest_s_per_simulated_s", "slowest_s_per_simulated_s"]].to_numpy().T
            axes.errorbar(
                middle, [codes.index(code) for code in of_bed["code"]], xerr=np.abs(ends - middle), fmt=shape,
                color=colour, markersize=5, capsize=2,
                label=f"{name}, {of_bed['particles'].max():.0f} particles",
            )  # fmt: skip
        axes.set_xscale("log")
        gas = set(done.dropna(subset="gas_step_s")["code"])
        axes.set_yticks(range(len(codes)), [code if code in gas else f"{code} (no gas)" for code in codes])
        axes.grid(axis="x", which="major", linewidth=0.3)
        axes.margins(y=0.1)
        axes.set_xlabel("wall time per simulated second [s/s], median and range")
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
        save_figure(figure, stem.with_suffix(".png"), stem.with_suffix(".pdf"), RESOLUTION_DPI)
