# SPDX-License-Identifier: GPL-3.0-or-later
"""How alike two states of a bed are, by coarse fields of solids and of their momentum.

Frames are compared as in recurrence CFD (Lichtenegger and Pirker 2016, Chem. Eng. Sci. 153, 394), by a norm
of the difference of fields; here solids and the velocity weighted by them, on coarse cells, so that neither
single particles nor the few that fly above the bed decide.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import pdist, squareform

from bedchain.chains.velocity_binning import velocities
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid


@dataclass(frozen=True)
class Likeness:
    """Fields of the frames of a window, each of the three brought to the same total variance.

    Parameters
    ----------
    coarse : Grid
        Cells of the fields.
    scale : (3,) array
        What solids, momentum along x and along z are divided by.
    fields : (n_frames, 3 n_coarse) float32 array
        Divided.
    """

    coarse: Grid
    scale: NDArray[np.float64]
    fields: NDArray[np.float32]

    def distances(self) -> NDArray[np.float64]:
        """Distance of each frame from each other, (n_frames, n_frames); its mean square is 6."""
        return np.asarray(squareform(pdist(self.fields.astype(np.float64))))

    def to(self, field: NDArray[np.float32]) -> NDArray[np.float64]:
        """Distance of one field, (3 n_coarse,), from those of all frames, (n_frames,)."""
        return np.asarray(np.sqrt(((self.fields.astype(np.float64) - field) ** 2).sum(axis=1)))

    def of(self, frames: Frames) -> NDArray[np.float32]:
        """Fields of the last of other frames, divided by the same, (3 n_coarse,)."""
        return _divided(_fields(frames.part(slice(-2, None)), self.coarse)[-1:], self.scale)[0]


def compare(frames: Frames, bed: Grid, coarse_m: float) -> Likeness:
    """Coarse fields of a window.

    Parameters
    ----------
    frames : Frames
        The window.
    bed : Grid
        Its size counts.
    coarse_m : float
        Edge of a coarse cell, about [m].

    Returns
    -------
    Likeness
    """
    columns, rows = (max(1, round(size / coarse_m)) for size in (bed.width_m, bed.height_m))
    coarse = Grid(bed.width_m, bed.height_m, columns, rows)
    fields = _fields(frames, coarse)
    scale = np.sqrt(fields.var(axis=0).sum(axis=1))
    scale[scale == 0] = 1.0
    return Likeness(coarse, scale, _divided(fields, scale))


def _fields(frames: Frames, coarse: Grid) -> NDArray[np.float64]:
    """Solids and their momentum in coarse cells, (n_frames, 3, n_coarse) [1, m/s, m/s]."""
    found = np.empty((len(frames.times_s), 3, coarse.n_cells))
    for row, (x, z, vx, vz) in enumerate(zip(frames.x_m, frames.z_m, *velocities(frames), strict=True)):
        cells = coarse.cell_of(x, z, row)
        for kind, weights in enumerate((None, vx, vz)):
            found[row, kind] = np.bincount(cells, weights, coarse.n_cells)
    return found


def _divided(fields: NDArray[np.float64], scale: NDArray[np.float64]) -> NDArray[np.float32]:
    return (fields / scale[:, None]).reshape(len(fields), -1).astype(np.float32)
