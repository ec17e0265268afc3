# SPDX-License-Identifier: GPL-3.0-or-later
"""Fig. 1: the numbered cells over the particles of one frame."""

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from bedchain.figures.style import SINGLE_COLUMN_IN, FigureFiles, close_frame, draw_particles, figure_style
from bedchain.files import write_csv
from bedchain.stage import run_stage
from bedchain.trajectory.cell_store import frame_at
from bedchain.trajectory.grid import OUTSIDE, Grid
from bedchain.trajectory.realisations import open_bed
from bedchain.trajectory.store import BedFiles

# more cells than these cannot carry a number that can be read
CORNER_COLUMNS, CORNER_ROWS = 5, 10
WHOLE_BED_LABELS = 11
GRID_COLOUR = "#666666"


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
    with figure_style():
        shape = min(grid.height_m / grid.width_m, 3.0)
        figure, (whole, corner) = plt.subplots(
            1, 2, figsize=(SINGLE_COLUMN_IN, max(2.6, min(1.45 * shape, 4.6))), width_ratios=[1, 1]
        )
        _draw_whole_bed(whole, grid, x, z, diameter_m, colour)
        _draw_corner(corner, whole, grid, x, z, diameter_m, colour)
        whole.set(xlabel=run.grid.labels[0], ylabel=run.grid.labels[1])
        corner.set_xlabel(run.grid.labels[0].split(" (")[0])
        whole.set_title(f"bed at {run.times_s[frame]:.2f} s")
        corner.set_title("its lower left corner")
        for axes in (whole, corner):
            axes.set_anchor("S")
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


def _draw_whole_bed(
    axes: Axes, grid: Grid, x: np.ndarray, z: np.ndarray, diameter: float, colour: str
) -> None:
    draw_particles(axes, x, z, diameter, facecolors=colour, linewidths=0)
    axes.vlines(grid.x_edges_m, 0, grid.height_m, colors=GRID_COLOUR, linewidths=0.25)
    axes.hlines(grid.z_edges_m, 0, grid.width_m, colors=GRID_COLOUR, linewidths=0.25)
    axes.set(xlim=(0, grid.width_m), ylim=(0, grid.height_m), xlabel="x [m]", ylabel="z [m]")
    axes.set_xticks([0, grid.width_m])
    rows = np.unique(np.linspace(0, grid.rows - 1, min(WHOLE_BED_LABELS, grid.rows)).astype(int))
    for row in rows:
        last = (row + 1) * grid.columns - 1
        axes.text(1.03 * grid.width_m, (row + 0.5) * grid.cell_height_m, str(last), va="center", fontsize=5.5)
    axes.text(
        1.27 * grid.width_m, grid.height_m / 2, "last cell of the row", rotation=90, va="center", fontsize=5.5
    )
    close_frame(axes, open_top=False)


def _draw_corner(
    axes: Axes, whole: Axes, grid: Grid, x: np.ndarray, z: np.ndarray, diameter: float, colour: str
) -> None:
    columns, rows = min(CORNER_COLUMNS, grid.columns), min(CORNER_ROWS, grid.rows)
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
    axes.set(xlim=(0, width), ylim=(0, height), xlabel="x [m]")
    axes.set_xticks([0, width], ["0", f"{width:.3g}"])
    close_frame(axes, open_top=False)
    whole.add_patch(Rectangle((0, 0), width, height, fill=False, edgecolor="black", linewidth=1.2, zorder=5))


if rule := globals().get("snakemake"):
    run_stage(plot_cells, rule)
