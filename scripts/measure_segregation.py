# SPDX-License-Identifier: GPL-3.0-or-later
"""Marked particles over time, by the DEM and by chains: results/<case>/segregation.csv."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from bedchain.comparison.segregation import Mixture, segregation_table
from bedchain.files import write_csv
from bedchain.measures.marks import Mark
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.frames import Window, lag_frames
from bedchain.trajectory.particles import read_particles
from bedchain.trajectory.realisations import open_bed
from bedchain.trajectory.store import BedFiles


def measure_segregation(
    bed: BedFiles, segregation: Path, marks: list[dict[str, Any]], folder: str, learning: Window,
    comparison: Window, lag_s: float, seed: int,
) -> None:  # fmt: skip
    """Follow each mark by the DEM, by one chain and, where it lasts, by a chain for it and one for the rest.

    Parameters
    ----------
    bed : BedFiles
    segregation : Path
        Table to make; see `comparison.segregation.segregation_table`.
    marks : list of dict
        Of the case.
    folder : str
        That files of ids are relative to.
    learning, comparison : Window
    lag_s : float
        Time of a step of the chains [s].
    seed : int
        Of the Monte Carlo runs.

    Raises
    ------
    UserError
        A mark asks for what the frames do not have.
    """
    run = open_bed(bed)
    learned, compared = run.window(learning), run.window(comparison)
    lag, particles = lag_frames(lag_s, run.interval_s), read_particles(bed.trajectory)
    first = compared.part(slice(0, 1))
    x, z = first.x_m[0], first.z_m[0]
    y = np.full(x.shape, run.grid.depth_m / 2) if first.y_m is None else first.y_m[0]
    tables = []
    for keys in marks:
        mark = Mark(**keys)
        marked = (
            mark.of_particles(particles, Path(folder)) if mark.lasts else mark.region(run.grid.size)(x, z, y)
        )
        mixture = Mixture(run.grid, learned.cells, compared.cells, marked, mark.lasts, lag, run.interval_s)
        tables.append(segregation_table(mark.name, mixture, seed))
        LOG.info("%s: %d of %d particles are marked", mark.name, marked.sum(), marked.size)
    table = pd.concat(tables, ignore_index=True)
    write_csv(table, segregation)
    for row in table[table["time_s"].isna()].itertuples():
        ends = f"({row.ci_low:.4g} to {row.ci_high:.4g})"
        LOG.info("%s, %s, mean %s: %.4g %s", row.mark, row.source, row.quantity, row.value, ends)


if rule := globals().get("snakemake"):
    run_stage(measure_segregation, rule)
