# SPDX-License-Identifier: GPL-3.0-or-later
"""Figs. 3 and 4: where a batch put in at the bottom is at six moments, by the DEM and by a chain."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.colors import PowerNorm

from bedchain.figures.style import (
    DOUBLE_COLUMN_IN,
    FigureFiles,
    close_frame,
    draw_cells,
    figure_style,
    map_colours,
    shown_height,
)
from bedchain.files import write_csv
from bedchain.measures.batch import observed_shares, total_variation
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.cell_store import open_cells
from bedchain.trajectory.grid import Grid

# the square root shows the thin parts of the batch beside its dense rest
GAMMA = 0.5
# colours end where all but this share of the particles in the cells of all moments are below
TOP_SHARE = 0.01
# less than this share of the batch in all rows above is not worth the room
NOT_SHOWN = 1e-3
# room for labels and the colour bar beside and above the maps, and between two of them
BESIDE_IN, ABOVE_IN, BETWEEN_IN = 1.45, 1.12, 0.18
TALLEST_IN = 3.4


def plot_distribution(
    cells: Path, chain: Path, files: FigureFiles,
    model: str, start_s: float, batch_height_m: float, colour_map: str
) -> None:  # fmt: skip
    """Draw the expected distribution of the chain beside the DEM's own, in one colour scale.

    Parameters
    ----------
    cells, chain : Path
        ``cells.npz`` and ``chain_<model>.npz``.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    model : str
        Name of the chain, where its file holds none.
    start_s : float
        When the batch is put in [s].
    batch_height_m : float
        Height of the batch [m].
    colour_map : str
        Name of a Matplotlib colour map.
    """
    store = open_cells(cells)
    with np.load(chain) as content:
        model = str(content["model"]) if "model" in content else model
        moments, expected, drawn = (
            content["moments_s"],
            content["batch_share"],
            content["batch_share_monte_carlo"],
        )
    observed = observed_shares(store, moments, start_s, batch_height_m)
    # the batch is finite: as many particles drawn from the chain itself differ from its expectation too
    by_dem, by_chance = (
        [100 * total_variation(*pair) for pair in zip(shares, expected, strict=True)]
        for shares in (observed, drawn)
    )
    notes = [f"differs {one:.0f} %\n(chance {two:.0f} %)" for one, two in zip(by_dem, by_chance, strict=True)]
    LOG.info(
        "total variation of the %s chain from the DEM at %s s: %s",
        model,
        moments,
        "; ".join(notes).replace("\n", " "),
    )
    with figure_style():
        draw_moments(store.grid, moments, observed, expected, notes, model, colour_map, files)
    write_csv(distribution_table(store.grid, moments, {"dem": observed, model: expected}), files.csv)


def draw_moments(
    grid: Grid, moments: np.ndarray, observed: np.ndarray, expected: np.ndarray, notes: list[str],
    model: str, colour_map: str, files: FigureFiles
) -> None:  # fmt: skip
    """Two rows of maps, the DEM above the chain, one column a moment, with one colour bar for all."""
    both = 100 * grid.projected(np.array([observed, expected]))
    (across, up), grid = grid.labels, grid.shown
    norm = PowerNorm(GAMMA, 0, np.quantile(both[both > 0], 1 - TOP_SHARE))
    height = _height_to_show(both, grid)
    panel_in = (DOUBLE_COLUMN_IN - BESIDE_IN) / len(moments) - BETWEEN_IN
    tall = min(height / grid.width_m * panel_in, TALLEST_IN)
    figure, panels = plt.subplots(
        2,
        len(moments),
        figsize=(DOUBLE_COLUMN_IN, 2 * tall + ABOVE_IN),
        sharex=True,
        sharey=True,
        squeeze=False,
    )
    for column, moment in enumerate(moments):
        for row in (0, 1):
            axes = panels[row, column]
            mesh = draw_cells(axes, both[row, column], grid, norm, map_colours(colour_map))
            axes.set(xlim=(0, grid.width_m), ylim=(0, height), xticks=[0, grid.width_m])
            close_frame(axes)
        panels[0, column].set_title(f"{moment:.2f} s")
        panels[1, column].set_title(notes[column], fontsize=6, pad=3)
        panels[1, column].set_xticklabels(["0", f"{grid.width_m:g}"])
    for axes, name in zip(panels[:, 0], ("DEM", f"{model} chain"), strict=True):
        axes.set_ylabel(f"{name}\n{up}")
    figure.supxlabel(across, fontsize=8)
    bar = figure.colorbar(mesh, ax=panels, extend="max", aspect=35, shrink=0.9, pad=0.015)
    bar.set_label("share of the batch in a cell [%]")
    bar.outline.set_linewidth(0.5)
    files.save(figure)


def _height_to_show(shares: np.ndarray, grid: Grid) -> float:
    """Height above which there is next to nothing in any map [m]."""
    by_row = shares.reshape(-1, grid.rows, grid.columns).sum(axis=2) / 100
    above = by_row[:, ::-1].cumsum(axis=1)[:, ::-1].max(axis=0)
    occupied = np.flatnonzero(above > NOT_SHOWN)
    return shown_height(occupied * grid.columns, grid)


def distribution_table(grid: Grid, moments: np.ndarray, sources: dict[str, np.ndarray]) -> pd.DataFrame:
    """Shares by moment, source and cell, in long form.

    Parameters
    ----------
    grid : Grid
    moments : (n_moments,) ndarray
        After the start [s].
    sources : dict of str to (n_moments, n_cells) ndarray
        Shares of the batch [1].

    Returns
    -------
    DataFrame
        time_s, source, cell, column, row, x_m, z_m (centres), share_1.
    """
    number = np.arange(grid.n_cells)
    parts = [
        pd.DataFrame(
            {
                "time_s": moment,
                "source": source,
                "cell": number,
                "column": grid.indices(number)[0],
                "row": grid.indices(number)[1],
                "x_m": grid.centres_m[:, 0],
                "z_m": grid.centres_m[:, 1],
                "share_1": share,
            }
        )
        for source, shares in sources.items()
        for moment, share in zip(moments, shares, strict=True)
    ]
    return pd.concat(parts, ignore_index=True)


if rule := globals().get("snakemake"):
    run_stage(plot_distribution, rule)
