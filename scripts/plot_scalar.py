# SPDX-License-Identifier: GPL-3.0-or-later
"""Heat to the side walls, carried by particles of a chain: its map, and what mixing lets through."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from numpy.typing import NDArray

from bedchain.chains import registry
from bedchain.chains.markov_chain import MarkovChain
from bedchain.chains.modes import slowest_modes
from bedchain.chains.scalar import effective_rate, scalar_chain
from bedchain.errors import UserError
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
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.grid import Grid

Array = NDArray[np.float64]
# rates of loss at the wall [1/s]
RATES = np.geomspace(0.01, 1000, 16)
# cells with fewer particles, as a share of the mean cell, are left white
FEWEST = 0.02


def plot_scalar(
    transitions: list[Path], files: FigureFiles, wall_loss_1_s: float, wall_m: float, colours: dict[str, str]
) -> None:
    """Draw the scalar of the first chain in the steady state, and the rate at which the bed loses it.

    Parameters
    ----------
    transitions : list of Path
        Static chains, with the case's and any other cells and lag.
    files : FigureFiles
        Figure in two forms, and the numbers behind it.
    wall_loss_1_s : float
        First-order loss beside the side walls, for the map [1/s].
    wall_m : float
        Width of the layer that loses, at each side wall [m].
    colours : dict of str to str
        Of each chain's name, by ``transitions_<name>``.

    Raises
    ------
    UserError
        A chain has no cells in rows and columns.
    """
    names = [file.stem.removeprefix("transitions_") for file in transitions]
    chains = {name: static_chain(file) for name, file in zip(names, transitions, strict=True)}
    density = {name: slowest_modes(chain.matrix, 1).density for name, chain in chains.items()}
    rows = [rates_of(name, chain, density[name], wall_m) for name, chain in chains.items()]
    table = pd.concat(rows, ignore_index=True)
    with figure_style():
        figure, panels = plt.subplots(1, 2, figsize=(DOUBLE_COLUMN_IN, 3.3), width_ratios=(1, 1.5))
        draw_map(
            panels[0],
            chains[names[0]],
            density[names[0]],
            beside_wall(chains[names[0]].grid, wall_m) * wall_loss_1_s,
        )
        panels[0].set_title(f"{names[0]} chain, {wall_loss_1_s:g} 1/s at the walls", loc="left", fontsize=7)
        draw_rates(panels[1], table, colours)
        files.save(figure)
    write_csv(table, files.csv)


def static_chain(file: Path) -> MarkovChain:
    """A chain whose states are its cells.

    Raises
    ------
    UserError
        It is of another kind.
    """
    chain = registry.load(file)
    if not isinstance(chain, MarkovChain) or chain.matrix.shape[0] != chain.grid.n_cells:
        raise UserError(f"{file}: a scalar is followed on static chains, whose states are cells")
    return chain


def beside_wall(grid: Grid, wall_m: float) -> Array:
    """Share of each cell that lies in the layer at either side wall, (n_cells,) [1]."""
    left, right = grid.x_edges_m[:-1], grid.x_edges_m[1:]
    inside = np.clip(wall_m - left, 0, right - left) + np.clip(
        right - (grid.width_m - wall_m), 0, right - left
    )
    return (inside / (right - left))[grid.indices(np.arange(grid.n_cells))[0]]


def rates_of(name: str, chain: MarkovChain, density: Array, wall_m: float) -> pd.DataFrame:
    """Rate of the bed over the rate at the wall: chain, wall_loss_1_s, bed_loss_1_s, well_mixed_1_s."""
    wall = beside_wall(chain.grid, wall_m)
    rates = [effective_rate(chain.matrix, density, rate * wall, chain.lag_s) for rate in RATES]
    mixed = RATES * float(density @ wall)
    LOG.info("%s: at the fastest loss the bed loses %.3g 1/s, as mixing lets it", name, rates[-1])
    return pd.DataFrame(
        {"chain": name, "wall_loss_1_s": RATES, "bed_loss_1_s": rates, "well_mixed_1_s": mixed}
    )


def draw_map(axes: Axes, chain: MarkovChain, density: Array, loss_1_s: Array) -> None:
    """Scalar of a particle by cell over the mean of all, in the steady state of an even gain."""
    held = density > FEWEST * density.max()
    states = density > 0
    inside = chain.matrix[states][:, states].tocsr()
    amounts = np.zeros(density.size)
    amounts[states] = scalar_chain(inside, loss_1_s[states], density[states], chain.lag_s).hold_up()
    relative = np.where(held, amounts / np.where(held, density, 1) / amounts.sum(), 0)
    norm = Normalize(relative[held].min(), relative[held].max())
    mesh = draw_cells(axes, relative, chain.grid, norm, map_colours("cividis"))
    axes.set_ylim(0, shown_height(np.flatnonzero(held), chain.grid))
    axes.set(xlabel="x [m]", ylabel="z [m]")
    close_frame(axes)
    axes.figure.colorbar(mesh, ax=axes, label="scalar over its mean [1]")


def draw_rates(axes: Axes, table: pd.DataFrame, colours: dict[str, str]) -> None:
    """Rate of the whole bed over that at the wall, with the limit of fast mixing."""
    for name, part in table.groupby("chain", sort=False):
        axes.plot(
            part["wall_loss_1_s"], part["bed_loss_1_s"], ".-", color=colours[str(name)], label=f"{name} chain"
        )
    axes.plot(
        part["wall_loss_1_s"], part["well_mixed_1_s"], ":", color="#222222", label="mixing without limit"
    )
    axes.set(
        xscale="log", yscale="log", xlabel="loss beside the walls [1/s]", ylabel="loss of the whole bed [1/s]"
    )
    axes.set_ylim(None, 5 * table["bed_loss_1_s"].max())
    axes.legend(loc="lower right")


if rule := globals().get("snakemake"):
    run_stage(plot_scalar, rule)
