# SPDX-License-Identifier: GPL-3.0-or-later
"""Slowest processes of each chain over the bed, and the circulation of its particles."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure

from bedchain.errors import UserError
from bedchain.figures.maps import NARROWEST_IN
from bedchain.figures.style import (
    DOUBLE_COLUMN_IN,
    MOST_SLENDER,
    FigureFiles,
    close_frame,
    draw_cells,
    figure_style,
    map_colours,
    shown_height,
)
from bedchain.files import write_csv
from bedchain.stage import run_stage
from bedchain.trajectory.cell_store import open_cells
from bedchain.trajectory.grid import Grid

# two hues that colour-blind readers tell apart, white where a process has no excess
COLOURS = LinearSegmentedColormap.from_list("excess", ["#10305f", "#5b8ec2", "#ffffff", "#f0a35b", "#8a3b00"])
# less than this share of the particles in all rows above is not worth the room
NOT_SHOWN = 1e-3
# cells with fewer particles, as a share of the mean cell, have no arrow
FEWEST = 0.1
# arrows in a row at most, and the length of the longest one between two arrows
ARROWS, LONGEST = 12, 1.6
LAYOUT = (0.03, 0, 0.97, 1)
BESIDE_IN, ABOVE_IN, TALLEST_IN = 2.9, 0.6, 2.9
# a panel is as wide as its title; a narrower one has no room for two numbers below it
TITLE_IN = 1.3


def plot_modes(modes: Path, cells: Path, files: FigureFiles) -> None:
    """Draw the two slowest processes of each model, and speed and direction of its net flow.

    Parameters
    ----------
    modes : Path
        ``modes.csv`` of diagnose_chains.
    cells : Path
        ``cells.npz``, for the grid.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.

    Raises
    ------
    UserError
        The table has no model.
    """
    whole, grid = pd.read_csv(modes, dtype={"part": str}), open_cells(cells).grid
    table, grid, labels = _seen_from_the_front(whole, grid), grid.shown, grid.labels
    sources = list(dict.fromkeys(table["source"]))
    if not sources:
        raise UserError(f"{modes} has no chain with a transition matrix: there are no modes to draw")
    height = _height_to_show(table, grid)
    number = int(table.loc[table["quantity"] == "excess", "part"].nunique())
    panel_in = (DOUBLE_COLUMN_IN - BESIDE_IN) / (number + 1)
    tall = min(height / grid.width_m * panel_in, TALLEST_IN)
    panel_in = tall / height * grid.width_m
    page_in = min(BESIDE_IN + (number + 1) * max(panel_in, TITLE_IN), DOUBLE_COLUMN_IN)
    ends = [0, grid.width_m] if panel_in > NARROWEST_IN else [grid.width_m]
    with figure_style():
        figure, panels = plt.subplots(
            len(sources), number + 1, figsize=(page_in, (tall + ABOVE_IN) * len(sources)),
            sharex=True, sharey=True, squeeze=False,
        )  # fmt: skip
        for row, source in zip(panels, sources, strict=True):
            _draw_model(figure, row, table[table["source"] == source], grid)
            row[0].set_ylabel(f"{source} chain\n{labels[1]}")
        for axes in panels.ravel():
            axes.set(xlim=(0, grid.width_m), ylim=(0, height))
            axes.set_xticks(ends, [f"{end:g}" for end in ends])
            axes.set_aspect("equal")
            close_frame(axes)
        for axes in panels[-1]:
            axes.set_xlabel(labels[0])
        # the labels on the left hang out of maps in the proportions of the bed, if these fill their room
        figure.set_layout_engine("constrained", rect=LAYOUT if panel_in > NARROWEST_IN else (0, 0, 1, 1))
        files.save(figure)
    write_csv(whole, files.csv)


def _draw_model(figure: Figure, row: np.ndarray, table: pd.DataFrame, grid: Grid) -> None:
    """One process a panel, then the circulation."""
    names = ("slowest process", "second process")
    for at, axes in enumerate(row[:-1]):
        of_process = table[table["part"] == str(at + 1)]
        if of_process.empty:
            axes.set_axis_off()
            continue
        scale = of_process.loc[of_process["quantity"] == "timescale", "value"].iloc[0]
        mesh = _draw_excess(axes, _values(of_process, "excess"), grid)
        axes.set_title(f"{names[at]}, {scale:.2g} s", loc="left")
    bar = figure.colorbar(mesh, ax=row[:-1], aspect=16, pad=0.02, ticks=[-1, 0, 1])
    bar.set_label("excess of particles\n[of the largest]")
    speed_bar = figure.colorbar(_draw_flow(row[-1], table, grid), ax=row[-1], aspect=16, pad=0.04)
    speed_bar.set_label("speed of the\nnet flow [m/s]")
    for each in (bar, speed_bar):
        each.outline.set_linewidth(0.5)
    row[-1].set_title("circulation", loc="left")


def _draw_excess(axes: Axes, values: np.ndarray, grid: Grid) -> QuadMesh:
    table = values.reshape(grid.rows, grid.columns)
    edges = (grid.x_edges_m, grid.z_edges_m)
    return axes.pcolormesh(*edges, table, norm=Normalize(-1, 1), cmap=COLOURS, rasterized=True)


def _draw_flow(axes: Axes, table: pd.DataFrame, grid: Grid) -> QuadMesh:
    """Speed of the net flow as colours, its direction as arrows of one length."""
    density = _values(table, "density")
    held = density > FEWEST / grid.n_cells
    flow = np.stack([_values(table, name) for name in ("flow_x", "flow_z")])
    velocity = np.divide(flow, density, out=np.zeros_like(flow), where=held)
    speed = np.hypot(*velocity)
    norm = Normalize(0, float(np.quantile(speed[held], 0.98)) if held.any() else 1.0)
    mesh = draw_cells(axes, speed, grid, norm, map_colours("YlGnBu"))
    every = max(1, -(-grid.columns // ARROWS))
    cell = np.arange(grid.n_cells)
    spread = (cell % grid.columns % every == every // 2) & (cell // grid.columns % every == every // 2)
    here = spread & (speed > 0)
    unit = velocity[:, here] / speed[here]
    length = 0.5 * LONGEST * every * min(grid.cell_width_m, grid.cell_height_m)
    axes.quiver(
        *grid.centres_m[here].T, *(unit * length), angles="xy", scale_units="xy", scale=1, pivot="mid",
        width=0.008, color="#222222",
    )  # fmt: skip
    return mesh


def _values(table: pd.DataFrame, quantity: str) -> np.ndarray:
    """Values of a quantity by cell number."""
    return table[table["quantity"] == quantity].sort_values("cell")["value"].to_numpy(float)


def _seen_from_the_front(table: pd.DataFrame, grid: Grid) -> pd.DataFrame:
    """The table with the layers of cells that lie behind each other added up."""
    if grid.layers == 1:
        return table
    table = table.assign(cell=table["cell"] % grid.shown.n_cells)
    keys = ["source", "quantity", "part", "cell"]
    times = table["quantity"] == "timescale"
    parts = (table[~times].groupby(keys, dropna=False, sort=False)["value"].sum(),
             table[times].groupby(keys, dropna=False, sort=False)["value"].first())  # fmt: skip
    return pd.concat(parts).reset_index()


def _height_to_show(table: pd.DataFrame, grid: Grid) -> float:
    """Height above which there are next to no particles in any chain [m]."""
    density = table[table["quantity"] == "density"].groupby("cell")["value"].max().to_numpy()
    by_row = density.reshape(grid.rows, grid.columns).sum(axis=1)
    above = by_row[::-1].cumsum()[::-1]
    height = shown_height(np.flatnonzero(above > NOT_SHOWN) * grid.columns, grid)
    return min(height, MOST_SLENDER * grid.width_m)


if rule := globals().get("snakemake"):
    run_stage(plot_modes, rule)
