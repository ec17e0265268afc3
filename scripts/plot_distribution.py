# SPDX-License-Identifier: GPL-3.0-or-later
"""Figs. 3 and 4: where a batch put in at the bottom is at six moments, by the DEM and by a chain."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.colors import PowerNorm
from matplotlib.figure import Figure

from bedchain.array_files import read_arrays
from bedchain.figures.maps import cell_columns, height_to_show, left_out_note, map_panels
from bedchain.figures.model_styles import label
from bedchain.figures.style import FigureFiles, draw_cells, figure_style, footnote, map_colours
from bedchain.files import write_csv
from bedchain.measures.batch import (
    batch_of,
    expected_total_variation,
    observed_shares,
    total_variation,
)
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.cell_store import CellStore, frame_at, open_cells
from bedchain.trajectory.grid import Grid
from bedchain.uncertainty.bands import block_band

# the square root shows the thin parts of the batch beside its dense rest
GAMMA = 0.5
# colours end where all but this share of the DEM's occupied cells of all moments are below
TOP_SHARE = 0.02
NOTE = """Above each map of the chain: share of the batch that would have to change cells to turn the DEM's
map into the chain's (total variation); in brackets, the same expected of as many particles as the batch drawn
from the chain's map. Cells with less than one particle's share, {least:.2g} %, are white."""


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
    content = read_arrays(chain)
    model = str(content["model"]) if "model" in content else model
    moments, expected = content["moments_s"], content["batch_share"]
    # the best chain of the scores has none
    without = content.get("batch_share_left_out", expected[:0])
    observed = observed_shares(store, moments, start_s, batch_height_m)
    start = np.asarray(store.cells[frame_at(store.times_s, start_s)])
    number = int(batch_of(store.grid, start, batch_height_m).sum())
    by_dem = [100 * total_variation(*pair) for pair in zip(observed, expected, strict=True)]
    # the batch is finite: as many particles drawn from the chain itself differ from its expectation too
    by_chance = [100 * expected_total_variation(shares, number) for shares in expected]
    LOG.info(
        "total variation of the %s chain from the DEM at %s s: %s %%; of particles drawn from it: %s %%",
        model, moments, np.round(by_dem), np.round(by_chance),
    )  # fmt: skip
    notes = [f"{dem:.0f} % ({chance:.0f} %)" for dem, chance in zip(by_dem, by_chance, strict=True)]
    with figure_style():
        height = height_to_show(store, moments, start_s)
        shares = np.array([observed, expected])
        files.save(draw_moments(store.grid, moments, shares, height, 1 / number, notes, model, colour_map))
    sources = {"dem": observed, model: expected}
    table = pd.concat([shares_of(store, moments, *source) for source in sources.items()], ignore_index=True)
    value, left_out = (store.grid.projected(shares) for shares in (expected, without))
    of_chain = table["source"] == model
    for name, end in zip(("ci_low", "ci_high"), block_band(value, left_out, "share"), strict=True):
        table.loc[of_chain, name] = end.ravel()
    write_csv(table, files.csv)


def draw_moments(
    grid: Grid, moments: np.ndarray, shares: np.ndarray, height: float, least: float,
    notes: list[str], model: str, colour_map: str,
) -> Figure:  # fmt: skip
    """Two rows of maps, the DEM above the chain, one column a moment, with one colour bar for all."""
    shares = grid.projected(shares)
    norm = PowerNorm(GAMMA, 0, 100 * np.quantile(shares[0][shares[0] > 0], 1 - TOP_SHARE))
    figure, panels = map_panels(grid, moments, 2, height)
    for row, name, of_row in zip(panels, ("DEM", label(model)), shares, strict=True):
        for axes, values in zip(row, of_row, strict=True):
            seen = np.where(values > 0.999 * least, 100 * values, 0)
            mesh = draw_cells(axes, seen, grid.shown, norm, map_colours(colour_map))
        row[0].set_ylabel(f"{name}\n{grid.labels[1]}")
    for axes, note in zip(panels[1], notes, strict=True):
        axes.set_title(note, fontsize=7, pad=3)
    bar = figure.colorbar(mesh, ax=panels, extend="max", aspect=35, shrink=0.9, pad=0.015)
    bar.set_label("share of the batch in a cell [%],\nsquare-root scale")
    bar.outline.set_linewidth(0.5)
    footnote(figure, f"{NOTE.format(least=100 * least)} {left_out_note(grid, height)}")
    return figure


def shares_of(store: CellStore, moments: np.ndarray, source: str, shares: np.ndarray) -> pd.DataFrame:
    """Shares of the batch by moment and cell: time_s, source, cell, column, row, x_m, z_m, share_1."""
    table = cell_columns(store.grid, moments).assign(share_1=shares.ravel())
    table.insert(1, "source", source)
    return table


if rule := globals().get("snakemake"):
    run_stage(plot_distribution, rule)
