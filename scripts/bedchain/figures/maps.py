# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of maps of the cells of a bed, one column a moment: their height, panels and table."""

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from numpy.typing import NDArray

from bedchain.figures.style import DOUBLE_COLUMN_IN, MOST_SLENDER, close_frame
from bedchain.trajectory.cell_store import CellStore, frame_at
from bedchain.trajectory.grid import OUTSIDE, Grid

# the rows above hold less than this share of the bed at each moment: splashes, not worth the room
NOT_SHOWN = 1e-3
# room for labels and the colour bar beside the maps, between two of them, and above and below a row
BESIDE_IN, BETWEEN_IN, ABOVE_IN, BELOW_IN = 1.45, 0.18, 0.42, 0.75
TALLEST_IN = 3.4
# room that the label of a colour bar needs beside the maps of one row; and a label of an axis
LOWEST_IN, TICK_IN = 1.5, 0.3
# a narrow map has no room for two numbers below it
NARROWEST_IN = 0.45


def height_to_show(store: CellStore, moments_s: NDArray[np.float64], start_s: float) -> float:
    """Height of the bed at some moments, the same whatever chain is drawn beside it.

    Parameters
    ----------
    store : CellStore
    moments_s : (n_moments,) array
        After the start [s].
    start_s : float
        [s]

    Returns
    -------
    float
        Whole rows that hold all but `NOT_SHOWN` of the particles at each moment, and one more; at least one
        width, at most `MOST_SLENDER` of them [m].
    """
    grid = store.grid
    frames = [frame_at(store.times_s, start_s + moment) for moment in moments_s]
    rows = [_highest_row(grid, np.asarray(store.cells[frame])) for frame in frames]
    width_m, row_m = grid.shown.width_m, grid.shown.cell_height_m
    square = max(1, round(width_m / row_m))
    return min(max(max(rows) + 2, square), grid.rows, int(MOST_SLENDER * square)) * row_m


def _highest_row(grid: Grid, cells: NDArray[np.integer]) -> int:
    rows = grid.indices(cells[cells != OUTSIDE])[1]
    return int(np.quantile(rows, 1 - NOT_SHOWN, method="lower"))


def map_panels(
    grid: Grid, moments_s: NDArray[np.float64], n_rows: int, height_m: float
) -> tuple[Figure, np.ndarray]:
    """Empty maps with walls, axes and the moments above them.

    Parameters
    ----------
    grid : Grid
    moments_s : (n_moments,) array
        [s]
    n_rows : int
    height_m : float
        Of the bed shown [m].

    Returns
    -------
    Figure
    (n_rows, n_moments) ndarray of Axes
    """
    width_m = grid.shown.width_m
    wide_in = (DOUBLE_COLUMN_IN - BESIDE_IN) / len(moments_s) - BETWEEN_IN
    tall_in = min(height_m / width_m * wide_in, TALLEST_IN)
    figure, panels = plt.subplots(
        n_rows, len(moments_s), sharex=True, sharey=True, squeeze=False,
        figsize=(DOUBLE_COLUMN_IN, max(n_rows * (tall_in + ABOVE_IN), LOWEST_IN + ABOVE_IN) + BELOW_IN),
    )  # fmt: skip
    wide_in = min(wide_in, tall_in * width_m / height_m)
    ends = [0, width_m] if wide_in > NARROWEST_IN else [width_m]
    for axes in panels.ravel():
        axes.set(xlim=(0, width_m), ylim=(0, height_m), aspect="equal", anchor="S")
        axes.set_xticks(ends, [f"{end:g}" for end in ends])
        axes.locator_params(axis="y", nbins=max(2, min(6, int(tall_in / TICK_IN))))
        close_frame(axes)
    for axes, moment in zip(panels[0], moments_s, strict=True):
        axes.set_title(f"{moment:.2f} s")
    for axes in panels[-1]:
        axes.set_xlabel(grid.labels[0].split(" (")[0], labelpad=1)
    return figure, panels


def left_out_note(grid: Grid, height_m: float) -> str:
    """What maps do not show: what is above a height, and what they add up where cells are not flat."""
    above = f"Maps end at {height_m:.3g} of {grid.shown.height_m:g} m."
    added_up = f"Maps: {grid.projection}."
    return " ".join([above] * (height_m < 0.999 * grid.shown.height_m) + [added_up] * bool(grid.projection))


def cell_columns(grid: Grid, moments_s: NDArray[np.float64]) -> pd.DataFrame:
    """Moment, number and place of each cell at each moment: the first columns of a table of maps.

    Parameters
    ----------
    grid : Grid
    moments_s : (n_moments,) array
        [s]

    Returns
    -------
    DataFrame
        time_s, cell, column, row, x_m, z_m (centres).
    """
    number = np.tile(np.arange(grid.n_cells), len(moments_s))
    return pd.DataFrame(
        {
            "time_s": np.repeat(moments_s, grid.n_cells),
            "cell": number,
            "column": grid.indices(number)[0],
            "row": grid.indices(number)[1],
            "x_m": grid.centres_m[number, 0],
            "z_m": grid.centres_m[number, 1],
        }
    )
