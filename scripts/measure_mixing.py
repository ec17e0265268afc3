# SPDX-License-Identifier: GPL-3.0-or-later
"""Mixing curves of a repeat of the DEM: results/<case>/repeats/<N>/mixing.csv."""

from pathlib import Path

import numpy as np

from bedchain.comparison.curves import curve_table
from bedchain.files import write_csv
from bedchain.measures.mixing import Splits, remaining_from_positions
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.frames import Window
from bedchain.trajectory.store import BedFiles


def measure_mixing(bed: BedFiles, mixing: Path, source: str, comparison: Window, splits: Splits) -> None:
    """Mark the particles at the start of the comparison and follow them.

    Parameters
    ----------
    bed : BedFiles
        Of the repeat.
    mixing : Path
        Table to make.
    source : str
        Name of the repeat in it, ``dem_1``, ``dem_2``, ...
    comparison : Window
    splits : Splits
    """
    store, described = bed.open()
    times_s = np.array(described["times_s"])
    frames = comparison.frames(times_s)
    remaining = remaining_from_positions(store[frames, 0], store[frames, 1], *splits)
    write_csv(curve_table(times_s[frames], source, remaining), mixing)
    LOG.info("%s: %d frames from %g s to %g s", source, len(remaining), *comparison)


if rule := globals().get("snakemake"):
    run_stage(measure_mixing, rule)
