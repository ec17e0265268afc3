# SPDX-License-Identifier: GPL-3.0-or-later
"""Products of a simulated bed of flat cells that a bed lacks, and why: results/<case>/left_out.csv."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from bedchain.case.cell_checks import not_flat
from bedchain.files import write_csv
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.store import BedFiles

OF_FRAMES = (
    ("snapshot, pressure drop, voidage of the gas", "no gas in the frames"),
    ("audit.csv", "stiffness, step and gas of the other code are not known"),
    ("fig2_cost, the DEM in timing.csv", "no timing of the code that wrote the frames"),
    ("noise floor of metrics.csv", "no repeats: the frames are there once"),
)
OF_FLAT_CELLS = "discussion.csv, fig_discussion; targets scores and tradeoff"
OF_GROUPS = "mixing.csv, metrics.csv, choice.csv, figures 3 to 5, film.mp4"
TRACERS = "a few tracers, not located in each frame, are no groups that mix"
LEAVING = "they follow particles of one frame, which leave the bed; residence.csv is of all"
NO_VELOCITIES = (
    "velocities of the frames, motion.csv",
    "no velocities: differences of positions are taken",
)


@dataclass(frozen=True)
class Cells:
    """Form of the cells, their layers, and whether particles may leave the bed."""

    form: str = "boxes"
    layers: int = 1
    outside: str = "refuse"


def list_left_out(bed: BedFiles, left_out: Path, cells: Cells, imported: bool, track: bool) -> None:
    """Write what is not made, and log it.

    Parameters
    ----------
    bed : BedFiles
    left_out : Path
        Gets product, reason.
    cells : Cells
    imported : bool
        Whether the bed is of frames, not simulated.
    track : bool
        Whether the frames are of a few tracers, not located in each of them.
    """
    values, _ = bed.open()
    rows = list(OF_FRAMES) if imported else []
    if not np.isfinite(values[0, 2:4]).any():
        rows.append(NO_VELOCITIES)
    if track:
        rows.append((OF_GROUPS, TRACERS))
        rows.append(
            ("fig_timescales, fig_modes", "a short track shows no slow process: ask for them by name")
        )
    elif cells.outside == "exit":
        rows.append((OF_GROUPS, LEAVING))
    if reason := not_flat(cells.form, cells.layers, cells.outside):
        rows.append((OF_FLAT_CELLS, reason))
    table = pd.DataFrame(rows, columns=["product", "reason"])
    write_csv(table, left_out)
    LOG.info("left out:\n%s", table.to_string(index=False))


if rule := globals().get("snakemake"):
    run_stage(list_left_out, rule)
