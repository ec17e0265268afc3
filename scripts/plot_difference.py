# SPDX-License-Identifier: GPL-3.0-or-later
"""Difference map of the batch of Figs. 3 and 4: static chain less dynamic chain."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection, QuadMesh
from matplotlib.colors import LinearSegmentedColormap, Normalize

from bedchain.array_files import read_arrays
from bedchain.errors import UserError, make_again
from bedchain.figures.maps import cell_columns, height_to_show, left_out_note, map_panels
from bedchain.figures.style import FigureFiles, figure_style, footnote
from bedchain.files import write_csv
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
# a map less high than this over its width leaves no room for a colour bar beside it
FLAT = 1.6
# height of a page with the bar below: that of maps so wide, and of what is above and below them [inches]
WIDE_IN, AROUND_IN = 0.95, 1.75
BESIDE: dict[str, Any] = {"pad": 0.015}
BELOW: dict[str, Any] = {"location": "bottom", "shrink": 0.5, "pad": 0.05}
NOTE = """Above each map: share of the batch that would have to change cells to turn one chain's map into
the other's (total variation); {mean:.1f} % in the mean of the moments. Hatched: the dynamic chain has more,
by over {hatched:.2g} % of the batch in a cell."""


def plot_difference(cells: Path, static: Path, dynamic: Path, files: FigureFiles, start_s: float) -> None:
    """Draw the expected distribution by the static less that by the dynamic chain, one map a moment.

    Parameters
    ----------
    cells : Path
        ``cells.npz``.
    static, dynamic : Path
        ``chain_static.npz`` and ``chain_dynamic.npz``.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    start_s : float
        When the batch is put in [s].

    Raises
    ------
    UserError
        The chains were run to other moments.
    """
    store = open_cells(cells)
    one, two = read_arrays(static), read_arrays(dynamic)
    moments, shares = one["moments_s"], (one["batch_share"], two["batch_share"])
    if not np.array_equal(moments, two["moments_s"]):
        raise UserError(f"{static} and {dynamic} have other moments; {make_again(static, dynamic)}")
    distances = np.array([total_variation(*pair) for pair in zip(*shares, strict=True)])
    LOG.info(
        "total variation of static and dynamic chain: %s, mean %.4f", distances.round(4), distances.mean()
    )
    with figure_style(), plt.rc_context({"hatch.linewidth": HATCH_WIDTH}):
        height = height_to_show(store, moments, start_s)
        draw_maps(store.grid, moments, 100 * (shares[0] - shares[1]), distances, height, files)
    write_csv(difference_table(store.grid, moments, shares, distances), files.csv)


def draw_maps(
    grid: Grid, moments: np.ndarray, difference: np.ndarray, distances: np.ndarray, height: float,
    files: FigureFiles
) -> None:  # fmt: skip
    """One map a moment in one colour scale, with the distance of both distributions above it."""
    difference = grid.projected(difference)
    limit = float(np.quantile(np.abs(difference[difference != 0]), 1 - TOP_SHARE))
    figure, panels = map_panels(grid, moments, 1, height)
    for axes, moment, values, distance in zip(panels[0], moments, difference, distances, strict=True):
        mesh = _draw_map(axes, values, grid.shown, limit)
        axes.set_title(f"{moment:.2f} s\n{100 * distance:.0f} %")
    panels[0, 0].set_ylabel(grid.labels[1])
    flat = height < FLAT * grid.shown.width_m
    if flat:
        figure.set_figheight(AROUND_IN + height / grid.shown.width_m * WIDE_IN)
    bar = figure.colorbar(mesh, ax=panels, extend="both", aspect=22, **(BELOW if flat else BESIDE))
    bar.set_label(f"static less dynamic chain{' ' if flat else chr(10)}[% of the batch in a cell]")
    span = bar.ax.axvspan if flat else bar.ax.axhspan
    span(-limit, -HATCHED * limit, fill=False, hatch=HATCH, edgecolor=HATCH_COLOUR, linewidth=0)
    bar.outline.set_linewidth(0.5)
    note = NOTE.format(mean=100 * distances.mean(), hatched=HATCHED * limit)
    footnote(figure, f"{note} {left_out_note(grid, height)}")
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
    static, dynamic = (share.ravel() for share in shares)
    return cell_columns(grid, moments).assign(
        static_share_1=static,
        dynamic_share_1=dynamic,
        difference_1=static - dynamic,
        total_variation_1=np.repeat(distances, grid.n_cells),
    )


if rule := globals().get("snakemake"):
    run_stage(plot_difference, rule)
