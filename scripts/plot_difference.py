# SPDX-License-Identifier: GPL-3.0-or-later
"""Difference map of the batch of Figs. 3 and 4: static chain less dynamic chain."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection, QuadMesh
from matplotlib.colors import LinearSegmentedColormap, Normalize

from bedchain.errors import UserError, make_again
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, close_frame, figure_style, shown_height
from bedchain.files import read_arrays, write_csv
from bedchain.measures.batch import total_variation
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.cell_store import open_cells
from bedchain.trajectory.grid import Grid

# two hues that colour-blind readers tell apart, white where both chains agree
COLOURS = LinearSegmentedColormap.from_list(
    "difference", ["#10305f", "#5b8ec2", "#ffffff", "#f0a35b", "#8a3b00"]
)
# cells in which the dynamic chain has clearly more are hatched, for readers without colours
HATCHED = 0.15
HATCH, HATCH_COLOUR, HATCH_WIDTH = "/" * 7, "#10305f", 0.3
# colours end where all but this share of the cells of all moments are below
TOP_SHARE = 0.005
# less than this share of the batch in all rows above is not worth the room
NOT_SHOWN = 1e-3
BESIDE_IN, ABOVE_IN, BETWEEN_IN = 1.45, 0.8, 0.18
TALLEST_IN = 3.4


def plot_difference(cells: Path, static: Path, dynamic: Path, files: FigureFiles) -> None:
    """Draw the expected distribution by the static less that by the dynamic chain, one map a moment.

    Parameters
    ----------
    cells : Path
        ``cells.npz``.
    static, dynamic : Path
        ``chain_static.npz`` and ``chain_dynamic.npz``.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.

    Raises
    ------
    UserError
        The chains were run to other moments.
    """
    grid = open_cells(cells).grid
    one, two = read_arrays(static), read_arrays(dynamic)
    moments, shares = one["moments_s"], (one["batch_share"], two["batch_share"])
    if not np.array_equal(moments, two["moments_s"]):
        raise UserError(f"{static} and {dynamic} have other moments; {make_again(static, dynamic)}")
    distances = np.array([total_variation(*pair) for pair in zip(*shares, strict=True)])
    LOG.info(
        "total variation of static and dynamic chain: %s, mean %.4f", distances.round(4), distances.mean()
    )
    with figure_style(), plt.rc_context({"hatch.linewidth": HATCH_WIDTH}):
        draw_maps(grid, moments, shares, distances, files)
    write_csv(difference_table(grid, moments, shares, distances), files.csv)


def draw_maps(
    grid: Grid, moments: np.ndarray, shares: tuple[np.ndarray, np.ndarray], distances: np.ndarray,
    files: FigureFiles
) -> None:  # fmt: skip
    """One map a moment in one colour scale, with the distance of both distributions above it."""
    static, dynamic = (grid.projected(share) for share in shares)
    (across, up), grid = grid.labels, grid.shown
    difference = 100 * (static - dynamic)
    limit = float(np.quantile(np.abs(difference[difference != 0]), 1 - TOP_SHARE))
    height = _height_to_show(np.maximum(static, dynamic), grid)
    panel_in = (DOUBLE_COLUMN_IN - BESIDE_IN) / len(moments) - BETWEEN_IN
    tall = min(height / grid.width_m * panel_in, TALLEST_IN)
    figure, panels = plt.subplots(
        1, len(moments), figsize=(DOUBLE_COLUMN_IN, tall + ABOVE_IN), sharey=True, squeeze=False
    )
    for axes, moment, values, distance in zip(panels[0], moments, difference, distances, strict=True):
        mesh = _draw_map(axes, values, grid, limit)
        axes.set(xlim=(0, grid.width_m), ylim=(0, height), xticks=[0, grid.width_m])
        axes.set_xticklabels(["0", f"{grid.width_m:g}"])
        axes.set_title(f"{moment:.2f} s\ndiffer by {100 * distance:.1f} %")
        close_frame(axes)
    panels[0, 0].set_ylabel(up)
    figure.supxlabel(across, fontsize=8)
    figure.text(0.995, 0.01, f"mean of the moments: {100 * distances.mean():.1f} %", ha="right", fontsize=8)
    bar = figure.colorbar(mesh, ax=panels, extend="both", aspect=22, pad=0.015)
    bar.set_label("static less dynamic\n[% of the batch in a cell]")
    bar.ax.axhspan(-limit, -HATCHED * limit, fill=False, hatch=HATCH, edgecolor=HATCH_COLOUR, linewidth=0)
    bar.outline.set_linewidth(0.5)
    files.save(figure)


def _draw_map(axes: Axes, values: np.ndarray, grid: Grid, limit: float) -> QuadMesh:
    table = values.reshape(grid.rows, grid.columns)
    edges = (grid.x_edges_m, grid.z_edges_m)
    mesh = axes.pcolormesh(*edges, table, norm=Normalize(-limit, limit), cmap=COLOURS, rasterized=True)
    x, z = (centre[values < -HATCHED * limit, None] for centre in grid.centres_m.T)
    corners_x = x + 0.5 * grid.cell_width_m * np.array([-1, 1, 1, -1])
    corners_z = z + 0.5 * grid.cell_height_m * np.array([-1, -1, 1, 1])
    corners = np.stack((corners_x, corners_z), axis=2)
    axes.add_collection(
        PolyCollection(list(corners), facecolors="none", edgecolors=HATCH_COLOUR, hatch=HATCH, linewidths=0)
    )
    axes.set_aspect("equal")
    return mesh


def _height_to_show(shares: np.ndarray, grid: Grid) -> float:
    """Height above which there is next to nothing in any map [m]."""
    by_row = shares.reshape(-1, grid.rows, grid.columns).sum(axis=2)
    above = by_row[:, ::-1].cumsum(axis=1)[:, ::-1].max(axis=0)
    return shown_height(np.flatnonzero(above > NOT_SHOWN) * grid.columns, grid)


def difference_table(
    grid: Grid, moments: np.ndarray, shares: tuple[np.ndarray, np.ndarray], distances: np.ndarray
) -> pd.DataFrame:
    """Both distributions, their difference and its total variation by moment and cell, in long form.

    Parameters
    ----------
    grid : Grid
    moments : (n_moments,) ndarray
        After the start [s].
    shares : two (n_moments, n_cells) ndarray
        Shares of the batch by the static and by the dynamic chain [1].
    distances : (n_moments,) ndarray
        Total variation of both [1].

    Returns
    -------
    DataFrame
        time_s, cell, column, row, x_m, z_m (centres), static_share_1, dynamic_share_1, difference_1,
        total_variation_1.
    """
    number, n = np.arange(grid.n_cells), len(moments)
    static, dynamic = (share.ravel() for share in shares)
    return pd.DataFrame(
        {
            "time_s": np.repeat(moments, grid.n_cells),
            "cell": np.tile(number, n),
            "column": np.tile(grid.indices(number)[0], n),
            "row": np.tile(grid.indices(number)[1], n),
            "x_m": np.tile(grid.centres_m[:, 0], n),
            "z_m": np.tile(grid.centres_m[:, 1], n),
            "static_share_1": static,
            "dynamic_share_1": dynamic,
            "difference_1": static - dynamic,
            "total_variation_1": np.repeat(distances, grid.n_cells),
        }
    )


if rule := globals().get("snakemake"):
    run_stage(plot_difference, rule)
