# SPDX-License-Identifier: GPL-3.0-or-later
"""The cell of every particle in every frame: results/<case>/cells.npz."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bedchain.stage import LOG, run_stage
from bedchain.trajectory.cell_store import open_cells, write_cells
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.store import BedFiles
from bedchain.trajectory.track import ergodicity_warning

# so few particles are tracers that stand for a bed
FEW = 10


@dataclass(frozen=True)
class Division:
    """How the bed is divided into cells; see `bedchain.trajectory.grid.Grid`.

    Attributes
    ----------
    columns, rows, layers : int
        Cells along the width, the height and the depth, or along what `form` has in their place [1].
    form : {"boxes", "rings", "sectors"}
    axis : {"vertical", "horizontal"}
        Of rings and sectors.
    thickness_m : float
        Depth of the bed [m].
    """

    columns: int
    rows: int
    layers: int = 1
    form: str = "boxes"
    axis: str = "vertical"
    thickness_m: float = 0.0


def assign_cells(
    bed: BedFiles, cells: Path, division: Division, diameter_m: float, outside: str = "refuse"
) -> None:
    """Lay a grid over the bed and note where every particle is.

    Parameters
    ----------
    bed : BedFiles
    cells : Path
        Gets int32 (n_frames, n_particles), with times and the grid.
    division : Division
    diameter_m : float
        Particle diameter, the finest length that the data resolve [m].
    outside : {"refuse", "exit"}
        Whether particles may leave the bed.

    Raises
    ------
    DataError
        A position outside the bed, or cells smaller than a particle.
    """
    values, described = bed.open()
    grid = Grid(
        described["width_m"], described["height_m"], division.columns, division.rows,
        described.get("depth_m", division.thickness_m), division.layers,
        form=division.form, axis=division.axis,
    )  # fmt: skip
    grid.check_resolution(diameter_m)
    y_row = described["columns"].index("y") if "y" in described["columns"] else None
    complete = described.get("complete", True)
    gone = write_cells(values, np.array(described["times_s"]), grid, cells, outside, y_row, complete)
    lengths = zip(grid.lengths_m, grid.counts, strict=True)
    size = " x ".join(
        f"{1000 * length / n:g} mm" for length, n in list(lengths)[: 3 if grid.layers > 1 else 2]
    )
    LOG.info("%d cells of %s, %d frames, in %s", grid.n_cells, size, len(values), cells)
    if values.shape[2] <= FEW:
        LOG.warning("warning: %s", ergodicity_warning(open_cells(cells).cells, grid.n_cells, values.shape[2]))
    if gone:
        share = gone / (values.shape[0] * values.shape[2])
        LOG.info("%.3g %% of particles times frames are not in the bed (outside: %s)", 100 * share, outside)


if rule := globals().get("snakemake"):
    run_stage(assign_cells, rule)
