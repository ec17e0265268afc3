# SPDX-License-Identifier: GPL-3.0-or-later
"""The cell of every particle in every frame: results/<case>/cells.npz."""

from pathlib import Path

import numpy as np

from bedchain.stage import LOG, run_stage
from bedchain.trajectory.cell_store import write_cells
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.store import BedFiles


def assign_cells(bed: BedFiles, cells: Path, columns: int, rows: int, diameter_m: float) -> None:
    """Lay a grid over the bed and note where every particle is.

    Parameters
    ----------
    bed : BedFiles
    cells : Path
        Gets int32 (n_frames, n_particles), with times and the grid.
    columns, rows : int
        Cells along the width and the height [1].
    diameter_m : float
        Particle diameter, the finest length that the data resolve [m].

    Raises
    ------
    DataError
        A position outside the bed, or cells smaller than a particle.
    """
    values, described = bed.open()
    grid = Grid(described["width_m"], described["height_m"], columns, rows)
    grid.check_resolution(diameter_m)
    write_cells(values, np.array(described["times_s"]), grid, cells)
    size = f"{1000 * grid.cell_width_m:g} mm x {1000 * grid.cell_height_m:g} mm"
    LOG.info("%d cells of %s, %d frames, in %s", grid.n_cells, size, len(values), cells)


if rule := globals().get("snakemake"):
    run_stage(assign_cells, rule)
