# SPDX-License-Identifier: GPL-3.0-or-later
"""Residence times of an open bed, by the DEM and by a chain: results/<case>/residence.csv."""

from pathlib import Path

import numpy as np
import pandas as pd

from bedchain.comparison.residence import of_chain, of_dem, residence_table
from bedchain.files import write_csv
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.frames import Window, lag_frames
from bedchain.trajectory.realisations import open_bed
from bedchain.trajectory.store import BedFiles

# F is given up to so many mean residence times, at most the length of the comparison
LONGEST = 4


def measure_residence(
    bed: BedFiles, residence: Path, learning: Window, comparison: Window, lag_s: float
) -> None:
    """Put the residence times that were seen beside those of a chain of cells with a feed and an exit.

    Parameters
    ----------
    bed : BedFiles
    residence : Path
        Table to make: quantity, source, time_s, value, unit, ci_low, ci_high.
    learning : Window
        The chain is learned from it.
    comparison : Window
        The DEM is looked at in it.
    lag_s : float
        Time of a step of the chain [s].

    Raises
    ------
    DataError
        In a window no particle enters, or none leaves.
    """
    run = open_bed(bed)
    learned, compared = run.window(learning), run.window(comparison)
    lag = lag_frames(lag_s, run.interval_s)
    most = (len(compared.times_s) - 1) // lag
    mean_s = of_chain(learned, run.grid.n_cells, lag, 0)(np.ones(5, bool)).numbers["mean"]
    steps = int(np.clip(np.ceil(LONGEST * mean_s / lag_s), 2, most))
    times = np.asarray(lag_s * np.arange(steps + 1), float)
    tables = [
        residence_table("dem", times, of_dem(compared, times)),
        residence_table("chain", times, of_chain(learned, run.grid.n_cells, lag, steps)),
    ]
    table = pd.concat(tables, ignore_index=True)
    write_csv(table, residence)
    for row in table[table["time_s"].isna()].itertuples():
        LOG.info(
            "%s, %s: %.4g %s (%.4g to %.4g)",
            row.source,
            row.quantity,
            row.value,
            row.unit,
            row.ci_low,
            row.ci_high,
        )


if rule := globals().get("snakemake"):
    run_stage(measure_residence, rule)
