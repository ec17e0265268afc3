# SPDX-License-Identifier: GPL-3.0-or-later
"""A saved chain run from another start: particles of a bed, marked at any time, in results/<bed>/applied.

usage: ./run apply CHAIN PARTICLES [--bed FOLDER] [--at SECONDS] [--for SECONDS] [--split METRES]

CHAIN is results/CASE/transitions_MODEL.npz. PARTICLES are left, right, low, up, or all of a bed: that of the
chain, or another one of the same material and size (--bed results/OTHER). Writes where the chain takes them
and, as far as the bed has frames, where they went: applied.csv (curves), cells.csv, and a figure of both.
"""

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from numpy.typing import NDArray

from bedchain.chains import registry
from bedchain.chains.between_steps import densities_at
from bedchain.chains.chain import Chain
from bedchain.errors import UserError, make_again, report_user_errors
from bedchain.figures.maps import cell_columns
from bedchain.figures.style import DOUBLE_COLUMN_IN, FigureFiles, figure_style, footnote
from bedchain.files import write_csv
from bedchain.measures.batch import share_by_cell, total_variation
from bedchain.measures.mixing import GROUPS, Splits, side_shares, sides
from bedchain.trajectory.cell_store import frame_at
from bedchain.trajectory.frames import TIME_TOLERANCE, lag_frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import Realisation, open_realisation

SIDES = [side for _, side in GROUPS]
DPI = 300
COLOURS = {"dem": "#222222", "chain": "#4477aa", "long_run": "#4477aa"}
LABELS = {"dem": "DEM", "chain": "chain", "long_run": "chain's long run"}
NOTE = "Chain of {learned}; particles of {bed} that were {side} at {at:g} s. Places are those of cells."


@dataclass(frozen=True)
class Start:
    """Particles to begin with.

    Attributes
    ----------
    side : {"left", "right", "low", "up", "all"}
    at_s : float or None
        When they are marked [s]; by default as late as frames of all of the time to come follow.
    for_s : float
        Time to come [s].
    split_m : float or None
        Line beside or above which they are [m]; by default the middle of the width or the mean height.
    """

    side: str
    at_s: float | None = None
    for_s: float = 2.0
    split_m: float | None = None


def apply_chain(transitions: Path, bed: Path, start: Start) -> Path:
    """Run a saved chain from particles of a bed.

    Parameters
    ----------
    transitions : Path
        ``transitions_<model>.npz``.
    bed : Path
        ``results/<case>`` with its trajectory.
    start : Start

    Returns
    -------
    Path
        The folder written: applied.csv, cells.csv, applied.png and applied.pdf.

    Raises
    ------
    UserError
        A file is missing, the bed is of another size or frame interval, or no particle is on the side.
    """
    for file in (transitions, bed / "trajectory.npy"):
        if not file.exists():
            raise UserError(f"{file} is missing: ./run {file}")
    run = open_realisation(str(bed), bed / "trajectory.npy", bed / "trajectory.json")
    chain = registry.load(transitions)
    check_fit(transitions, chain, run)
    at = first_frame(run, start)
    length = max(1, round(start.for_s / run.interval_s))
    splits = splits_of(run, at, start)
    table, cells = prediction(chain, transitions, run, at, length, splits, start)
    name = f"{transitions.parent.name}_{chain.name}_{start.side}_{run.times_s[at]:g}s"
    folder = bed / "applied" / name
    folder.mkdir(parents=True, exist_ok=True)
    write_csv(cells, folder / "cells.csv")
    files = FigureFiles(folder / "applied.png", folder / "applied.pdf", folder / "applied.csv", DPI)
    note = NOTE.format(learned=transitions.parent, bed=bed, side=start.side, at=run.times_s[at])
    with figure_style():
        files.save(draw(table, start.side, note))
    write_csv(table, files.csv)
    return folder


def check_fit(transitions: Path, chain: Chain, run: Realisation) -> None:
    """Refuse a bed that the chain's cells do not cover, or frames that are not of its step."""
    grid = chain.grid
    for axis, of_bed, of_chain in (
        ("wide", run.width_m, grid.width_m),
        ("high", run.height_m, grid.height_m),
    ):
        if abs(of_bed - of_chain) > TIME_TOLERANCE * of_chain:
            raise UserError(
                f"{run.name} is {of_bed:g} m {axis}, the bed of {transitions} {of_chain:g} m: a chain of "
                "cells holds for a bed of its own size and material only"
            )
    lag_frames(chain.lag_s, run.interval_s)


def first_frame(run: Realisation, start: Start) -> int:
    """Frame at which the particles are marked."""
    if start.at_s is not None:
        return frame_at(run.times_s, start.at_s)
    return max(0, len(run.times_s) - 1 - round(start.for_s / run.interval_s))


def splits_of(run: Realisation, at: int, start: Start) -> Splits:
    """The line of the side at the given place, the other one through the middle."""
    of_x = start.side in SIDES[:2]
    split_x_m, split_z_m = run.width_m / 2, float(np.nanmean(run.values[at, 1]))
    if start.split_m is None:
        return Splits(split_x_m, split_z_m)
    return Splits(start.split_m, split_z_m) if of_x else Splits(split_x_m, start.split_m)


def marked_particles(run: Realisation, at: int, splits: Splits, side: str) -> NDArray[np.bool_]:
    """Which particles are on a side, (n_particles,).

    Raises
    ------
    UserError
        None is.
    """
    x, z = run.values[at, :2]
    on = np.isfinite(x) if side == "all" else sides(x, z, *splits)[SIDES.index(side)]
    if not on.any():
        line = splits.split_x_m if side in SIDES[:2] else splits.split_z_m
        raise UserError(
            f"no particle of {run.name} is {side} of the line at {line:g} m at {run.times_s[at]:g} s: "
            "choose another --split"
        )
    return np.asarray(on)


def prediction(
    chain: Chain, transitions: Path, run: Realisation, at: int, length: int, splits: Splits, start: Start
) -> tuple[pd.DataFrame, pd.DataFrame]:  # fmt: skip
    """Curves and cells of the marked particles by the chain, and by the frames as far as they go.

    Returns
    -------
    DataFrame
        time_s, source (chain, dem, long_run), remaining_1 (share on its side), x_m and height_m
        (means), difference_1 (total variation from the chain).
    DataFrame
        time_s, cell, column, row, x_m, z_m, chain_1, dem_1 (shares).
    """
    lag, fractions = lag_frames(chain.lag_s, run.interval_s), registry.load_fractions(transitions)
    if fractions.lag != lag:
        raise UserError(f"{transitions} answers at whole steps only; {make_again(transitions)}")
    before = run.leading_to(chain.grid, at, lag)
    marked = marked_particles(run, at, splits, start.side)
    frames = range(length + 1)
    shares = densities_at(chain, fractions, before, marked[None], frames)[:, 0] / marked.sum()
    seen = min(len(run.times_s) - at, length + 1)
    cells = run.frames(chain.grid, slice(at, at + seen)).cells if seen > 1 else before.cells[-1:]
    observed = np.array([share_by_cell(np.asarray(now)[marked], chain.grid.n_cells) for now in cells])
    long_run = np.repeat(chain.long_run_density(before)[None], length + 1, axis=0)
    times = run.times_s[at] + run.interval_s * np.arange(length + 1)
    sources = {"chain": shares, "dem": observed, "long_run": long_run}
    table = pd.concat(
        [curves(chain.grid, times, name, of, shares, splits, start.side) for name, of in sources.items()]
    )
    of_cells = cell_columns(chain.grid, times).assign(chain_1=shares.ravel())
    of_cells["dem_1"] = np.concatenate((observed.ravel(), np.full(of_cells.shape[0] - observed.size, np.nan)))
    return table, of_cells


def curves(
    grid: Grid, times_s: NDArray[np.float64], source: str, shares: NDArray[np.float64],
    chain: NDArray[np.float64], splits: Splits, side: str,
) -> pd.DataFrame:  # fmt: skip
    """What shares of cells say at each time, all from the middles of the cells."""
    on = np.ones(grid.n_cells) if side == "all" else side_shares(grid, *splits)[SIDES.index(side)]
    middles = grid.centres_m
    return pd.DataFrame(
        {
            "time_s": times_s[: len(shares)],
            "source": source,
            "remaining_1": shares @ on,
            "x_m": shares @ middles[:, 0],
            "height_m": shares @ middles[:, 1],
            "difference_1": [total_variation(*pair) for pair in zip(shares, chain, strict=False)],
        }
    )


def draw(table: pd.DataFrame, side: str, note: str) -> Figure:
    """Share on its side and mean place over time, by the frames and by the chain."""
    panels_of = {"x_m": "mean x [m]", "height_m": "mean height [m]"}
    if side != "all":
        panels_of = {"remaining_1": f"share that is {side} [1]"} | panels_of
    figure, panels = plt.subplots(1, len(panels_of), figsize=(DOUBLE_COLUMN_IN, 2.6))
    for axes, (column, quantity) in zip(panels, panels_of.items(), strict=True):
        for source, label in LABELS.items():
            of = table[table["source"] == source]
            dots = ":" if source == "long_run" else "-"
            axes.plot(of["time_s"], of[column], dots, color=COLOURS[source], label=label)
        axes.set(xlabel="time [s]", ylabel=quantity)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=len(LABELS))
    footnote(figure, note)
    return figure


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, usage=argparse.SUPPRESS
    )
    parser.add_argument("chain", type=Path, help="results/CASE/transitions_MODEL.npz")
    parser.add_argument("particles", choices=[*SIDES, "all"], help="which particles of the bed")
    parser.add_argument("--bed", type=Path, help="folder of a bed; by default that of the chain")
    parser.add_argument("--at", type=float, help="when they are marked [s]; by default the last moment that "
                        "has frames for the whole time to come")  # fmt: skip
    parser.add_argument("--for", type=float, default=2.0, dest="for_s", help="time to come [s]; 2")
    parser.add_argument("--split", type=float, help="line of the side [m]; by default the middle of the "
                        "width, or the mean height")  # fmt: skip
    given = parser.parse_args()
    with report_user_errors():
        bed = given.bed or given.chain.parent
        folder = apply_chain(given.chain, bed, Start(given.particles, given.at, given.for_s, given.split))
        print(pd.read_csv(folder / "applied.csv").pipe(summary))
        print(folder)


def summary(table: pd.DataFrame) -> str:
    """Means over the time to come, a line a source."""
    later = table[table["time_s"] > table["time_s"].min()]
    return later.drop(columns="time_s").groupby("source", sort=False).mean().round(4).to_string()


if __name__ == "__main__":
    main()
