# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain learned from the learning window: results/<case>/transitions_<model>.npz."""

from pathlib import Path
from typing import Any

from bedchain.case.chosen import read_choice
from bedchain.chains import registry
from bedchain.chains.between_steps import learn_fractions
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.frames import Window, lag_frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import open_bed
from bedchain.trajectory.store import BedFiles


def build_transitions(
    bed: BedFiles, transitions: Path, model: str, estimator: str, lag_s: float, learning: Window,
    options: dict[str, Any] | None = None, choice: Path | None = None,
) -> None:  # fmt: skip
    """Count the moves between cells in a window and make a chain of them, for its steps and fractions of one.

    Parameters
    ----------
    bed : BedFiles
    transitions : Path
        Gets the chain, for `bedchain.chains.registry.load` and `load_fractions`.
    model : str
        A name in `bedchain.chains.registry.LEARNERS`, or ``chosen``.
    estimator : {"literal", "per_step", "pooled"}
        How counts become probabilities.
    lag_s : float
        Time of one step of the chain [s].
    learning : Window
    options : dict, optional
        Settings of this model only.
    choice : Path, optional
        ``choice.csv``, whose lag and cells the model ``chosen`` has instead of those of the case.

    Raises
    ------
    DataError
        An empty window, a lag that is no multiple of the frame interval; nothing is written then.
    """
    run = open_bed(bed)
    grid = run.grid
    if model == registry.CHOSEN and choice:
        lag_s, columns, rows = read_choice(choice)
        grid = Grid(grid.width_m, grid.height_m, columns, rows)
    frames = run.frames(grid, learning.frames(run.times_s))
    lag = lag_frames(lag_s, frames.interval_s)
    chain = registry.learn(model, frames, grid, lag, estimator, **(options or {}))
    registry.save(chain, transitions, learn_fractions(frames, grid.n_cells, lag, estimator))
    for name, value in chain.report.items():
        LOG.info("%s chain, %s: %.6g", model, name, value)


if rule := globals().get("snakemake"):
    run_stage(build_transitions, rule)
