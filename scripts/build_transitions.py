# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain learned from the learning window: results/<case>/transitions_<model>.npz."""

from pathlib import Path
from typing import Any

from bedchain.chains import registry
from bedchain.stage import LOG, stage
from bedchain.trajectory.frames import lag_frames
from bedchain.trajectory.realisations import open_realisation


def build_transitions(
    trajectory: Path, metadata: Path, cells: Path, transitions: Path,
    model: str, estimator: str, lag_s: float, start_s: float, end_s: float,
    options: dict[str, Any] | None = None,
) -> None:  # fmt: skip
    """Count the moves between cells in a window and make a chain of them.

    Parameters
    ----------
    trajectory, metadata, cells : Path
        ``trajectory.npy``, ``trajectory.json``, ``cells.npz``.
    transitions : Path
        Gets the chain, for `bedchain.models.load`.
    model : str
        A name in `bedchain.models.LEARNERS`.
    estimator : {"literal", "per_step", "pooled"}
        How counts become probabilities.
    lag_s : float
        Time of one step of the chain [s].
    start_s, end_s : float
        The learning window [s].
    options : dict, optional
        Settings of this model only.

    Raises
    ------
    DataError
        An empty window, a lag that is no multiple of the frame interval; nothing is written then.
    """
    bed = open_realisation("the run", trajectory, metadata, cells)
    frames = bed.window(start_s, end_s)
    lag = lag_frames(lag_s, frames.interval_s)
    chain = registry.learn(model, frames, bed.grid, lag, estimator, **(options or {}))
    registry.save(chain, transitions)
    for name, value in chain.report.items():
        LOG.info("%s chain, %s: %.6g", model, name, value)


if "snakemake" in globals():
    with stage(snakemake.log[0]):
        build_transitions(
            Path(snakemake.input.trajectory),
            Path(snakemake.input.metadata),
            Path(snakemake.input.cells),
            Path(snakemake.output.transitions),
            snakemake.wildcards.model,
            snakemake.params.estimator,
            snakemake.params.lag_s,
            snakemake.params.start_s,
            snakemake.params.end_s,
            snakemake.params.options,
        )
