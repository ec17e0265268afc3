# SPDX-License-Identifier: GPL-3.0-or-later
"""Mixing curves of a repeat of the DEM: results/<case>/repeats/<N>/mixing.csv."""

from pathlib import Path

import numpy as np

from bedchain.comparison.curves import curve_table
from bedchain.files import write_csv
from bedchain.measures.mixing import remaining_from_positions
from bedchain.stage import LOG, stage
from bedchain.trajectory.frames import window
from bedchain.trajectory.store import open_trajectory


def measure_mixing(
    trajectory: Path, metadata: Path, mixing: Path,
    source: str, start_s: float, end_s: float, split_x_m: float, split_z_m: float,
) -> None:  # fmt: skip
    """Mark the particles at the start of the comparison and follow them.

    Parameters
    ----------
    trajectory, metadata : Path
        ``trajectory.npy`` and ``trajectory.json`` of the repeat.
    mixing : Path
        Table to make.
    source : str
        Name of the repeat in it, ``dem_1``, ``dem_2``, ...
    start_s, end_s : float
        The comparison window [s].
    split_x_m, split_z_m : float
        Lines between left and right, low and up [m].
    """
    store, described = open_trajectory(trajectory, metadata)
    times_s = np.array(described["times_s"])
    frames = window(times_s, start_s, end_s)
    remaining = remaining_from_positions(store[frames, 0], store[frames, 1], split_x_m, split_z_m)
    write_csv(curve_table(times_s[frames], source, remaining), mixing)
    LOG.info("%s: %d frames from %g s to %g s", source, len(remaining), start_s, end_s)


if "snakemake" in globals():
    with stage(snakemake.log[0]):
        measure_mixing(
            Path(snakemake.input.trajectory),
            Path(snakemake.input.metadata),
            Path(snakemake.output.mixing),
            snakemake.params.source,
            snakemake.params.start_s,
            snakemake.params.end_s,
            snakemake.params.split_x_m,
            snakemake.params.split_z_m,
        )
