# SPDX-License-Identifier: GPL-3.0-or-later
"""Fig. 1: the numbered cells over the particles of one frame."""

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from bedchain.figures.style import (
    MOST_SLENDER,
    SINGLE_COLUMN_IN,
    FigureFiles,
    close_frame,
    draw_particles,
    figure_style,
    footnote,
    shown_height,
)
from bedchain.files import write_csv
from bedchain.stage import run_stage
from bedchain.trajectory.cell_store import frame_at
from bedchain.trajectory.grid import OUTSIDE, Grid
from bedchain.trajectory.realisations import open_bed
from bedchain.trajectory.store import BedFiles

# more cells than these cannot carry a number that can be read
CORNER_COLUMNS, CORNER_ROWS = 5, 12
# rows of the bed whose first cell is named, at most
NAMED_ROWS = 11
GRID_COLOUR = "#666666"
PANEL_IN, LOWEST_IN, TALLEST_IN = 1.05, 1.15, 4.4
# room for axes and titles
AROUND_IN = 0.75


def plot_cells(bed: BedFiles, files: FigureFiles, time_s: float, diameter_m: float, colour: str) -> None:
    """Draw the whole bed with its cells, and its lower left corner with all numbers.

    Parameters
    ----------
    bed : BedFiles
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    time_s : float
        Time of the frame [s].
    diameter_m : float
        Particle diameter [m].
    colour : str
        Colour of the particles.
    """
    run = open_bed(bed)
    frame = frame_at(run.times_s, time_s)
    seen = run.frames(run.grid, slice(frame, frame + 1))
    inside = seen.cells[0] != OUTSIDE
    y_m = None if seen.y_m is None else np.asarray(seen.y_m[0], float)[inside]
    x, z = (np.asarray(at[0], float)[inside] for at in (seen.x_m, seen.z_m))
    x, z = run.grid.picture(x, z, y_m)
    held = np.bincount(seen.cells[0][inside], minlength=run.grid.n_cells)
    grid = run.grid.shown
    height = _height_to_show(grid, run.grid.projected(held))
    columns = min(CORNER_COLUMNS, grid.columns)
    rows = round(columns * grid.cell_width_m * height / grid.width_m / grid.cell_height_m)
    rows = min(max(rows, 1), CORNER_ROWS, grid.rows)
    with figure_style():
        tall = min(max(PANEL_IN * height / grid.width_m, LOWEST_IN), TALLEST_IN)
        figure, (whole, corner) = plt.subplots(1, 2, figsize=(SINGLE_COLUMN_IN, tall + AROUND_IN))
        _draw_whole_bed(whole, grid, x, z, diameter_m, colour, height)
        _draw_corner(corner, grid, x, z, diameter_m, colour, (columns, rows))
        size = (columns * grid.cell_width_m, rows * grid.cell_height_m)
        whole.add_patch(Rectangle((0, 0), *size, fill=False, edgecolor="black", linewidth=1.2, zorder=5))
        across, up = run.grid.labels
        for axes in (whole, corner):
            axes.set(xlabel=across.split(" (")[0], ylabel=up)
        whole.set_title(f"bed at {run.times_s[frame]:.2f} s")
        corner.set_title("lower left corner")
        if note := _note(run.grid, height):
            footnote(figure, note)
        files.save(figure)
    write_csv(cell_table(run.grid, held, run.times_s[frame]), files.csv)


def cell_table(grid: Grid, held: np.ndarray, time_s: float) -> pd.DataFrame:
    """Numbers, places and contents of the cells.

    Parameters
    ----------
    grid : Grid
    held : (n_cells,) ndarray
        Particles in each cell [1].
    time_s : float
        Time of the frame [s].

    Returns
    -------
    DataFrame
        cell, column, row, x_m, z_m (centres), particles_1, time_s.
    """
    number = np.arange(grid.n_cells)
    return pd.DataFrame(
        {
            "cell": number,
            "column": grid.indices(number)[0],
            "row": grid.indices(number)[1],
            "x_m": grid.centres_m[:, 0],
            "z_m": grid.centres_m[:, 1],
            "particles_1": held,
            "time_s": time_s,
        }
    )


def _note(grid: Grid, height: float) -> str:
    """What the picture leaves out: cells above it, and what is behind it."""
    size = f"{grid.columns} x {grid.rows} in all"
    above = f"Cells and bed go on above, to {grid.shown.height_m:g} m: {size}."
    behind = f"The picture is a projection ({grid.projection})."
    return " ".join([above] * (height < grid.shown.height_m) + [behind] * bool(grid.projection))


def _height_to_show(grid: Grid, held: np.ndarray) -> float:
    """Height of the rows that hold particles, and one more, unless that is too flat or too slender [m]."""
    height = max(shown_height(np.flatnonzero(held), grid), grid.width_m)
    return min(height, MOST_SLENDER * grid.width_m, grid.height_m)


def _draw_whole_bed(
    axes: Axes, grid: Grid, x: np.ndarray, z: np.ndarray, diameter: float, colour: str, height: float
) -> None:
    draw_particles(axes, x, z, diameter, facecolors=colour, linewidths=0)
    axes.vlines(grid.x_edges_m, 0, grid.height_m, colors=GRID_COLOUR, linewidths=0.25)
    axes.hlines(grid.z_edges_m, 0, grid.width_m, colors=GRID_COLOUR, linewidths=0.25)
    axes.set(xlim=(0, grid.width_m), ylim=(0, height), anchor="S")
    axes.set_xticks([0, grid.width_m], ["0", f"{grid.width_m:g}"])
    rows = np.arange(0, round(height / grid.cell_height_m), _every(height / grid.cell_height_m))
    numbers = axes.secondary_yaxis("right")
    numbers.set_yticks((rows + 0.5) * grid.cell_height_m, [str(row * grid.columns) for row in rows])
    numbers.tick_params(labelsize=5.5, length=1.5)
    numbers.set_ylabel("first cell of the row", fontsize=6.5)
    close_frame(axes, open_top=False)


def _every(rows: float) -> int:
    """Regular spacing of the rows that are named: 1, 2, 5, 10, 20, ..."""
    steps = (lead * 10**power for power in range(9) for lead in (1, 2, 5))
    return next(step for step in steps if rows <= NAMED_ROWS * step)


def _draw_corner(
    axes: Axes, grid: Grid, x: np.ndarray, z: np.ndarray, diameter: float, colour: str, shown: tuple[int, int]
) -> None:
    columns, rows = shown
    width, height = columns * grid.cell_width_m, rows * grid.cell_height_m
    near = (x < width + diameter) & (z < height + diameter)
    draw_particles(axes, x[near], z[near], diameter, facecolors=colour, edgecolors="white", linewidths=0.15)
    axes.vlines(grid.x_edges_m[: columns + 1], 0, height, colors=GRID_COLOUR, linewidths=0.5)
    axes.hlines(grid.z_edges_m[: rows + 1], 0, width, colors=GRID_COLOUR, linewidths=0.5)
    for row in range(rows):
        for column in range(columns):
            x_m, z_m = grid.centres_m[row * grid.columns + column]
            axes.text(
                x_m, z_m, str(row * grid.columns + column), ha="center", va="center", fontsize=6,
                bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 0.6},
            )  # fmt: skip
    axes.set(xlim=(0, width), ylim=(0, height), anchor="S")
    axes.set_xticks([0, width], ["0", f"{width:.3g}"])
    close_frame(axes, open_top=False)


if rule := globals().get("snakemake"):
    run_stage(plot_cells, rule)
