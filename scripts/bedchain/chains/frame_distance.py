# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances between frames, by coarse fields of the solids and of their momentum.

Frames are compared as in recurrence CFD (Lichtenegger and Pirker 2016, Chem. Eng. Sci. 153, 394), by a norm
of the difference of their fields. Here the fields are the number of particles and the sums of their
velocities in coarse cells, so that single particles have little weight, and so have the few above the bed.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import pdist, squareform

from bedchain.chains.velocity_binning import velocities
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid


@dataclass(frozen=True)
class FrameFields:
    """Three fields of each frame of a window, each scaled to a total variance of 1.

    Parameters
    ----------
    coarse : Grid
        Cells of the fields.
    scale : (3,) array
        Divisors of solids, momentum along x and momentum along z [1, m/s, m/s].
    fields : (n_frames, 3 n_coarse) float32 array
        Scaled [1].
    """

    coarse: Grid
    scale: NDArray[np.float64]
    fields: NDArray[np.float32]

    def distances(self) -> NDArray[np.float64]:
        """Distance of each frame from each other, (n_frames, n_frames) [1]; its mean square is 6."""
        return np.asarray(squareform(pdist(self.fields.astype(np.float64))))

    def distances_from(self, field: NDArray[np.float32]) -> NDArray[np.float64]:
        """Distances of all frames from one field, (3 n_coarse,); (n_frames,) [1]."""
        return np.asarray(np.sqrt(((self.fields.astype(np.float64) - field) ** 2).sum(axis=1)))

    def last_of(self, frames: Frames) -> NDArray[np.float32]:
        """Fields of the last of other frames, with the same scale, (3 n_coarse,) [1]."""
        return _scaled(_fields(frames.part(slice(-2, None)), self.coarse)[-1:], self.scale)[0]


def frame_fields(frames: Frames, bed: Grid, coarse_m: float) -> FrameFields:
    """Coarse fields of a window.

    Parameters
    ----------
    frames : Frames
        The window.
    bed : Grid
        Any grid of the bed: only its size is used.
    coarse_m : float
        Approximate edge of a coarse cell [m].

    Returns
    -------
    FrameFields
    """
    columns, rows = (max(1, round(size / coarse_m)) for size in (bed.width_m, bed.height_m))
    coarse = Grid(bed.width_m, bed.height_m, columns, rows)
    fields = _fields(frames, coarse)
    scale = np.sqrt(fields.var(axis=0).sum(axis=1))
    scale[scale == 0] = 1.0
    return FrameFields(coarse, scale, _scaled(fields, scale))


def _fields(frames: Frames, coarse: Grid) -> NDArray[np.float64]:
    """Solids and their momentum in coarse cells, (n_frames, 3, n_coarse) [1, m/s, m/s]."""
    fields = np.empty((len(frames.times_s), 3, coarse.n_cells))
    for row, (x, z, vx, vz) in enumerate(zip(frames.x_m, frames.z_m, *velocities(frames), strict=True)):
        cells = coarse.cell_of(x, z, row)
        for kind, weights in enumerate((None, vx, vz)):
            fields[row, kind] = np.bincount(cells, weights, coarse.n_cells)
    return fields


def _scaled(fields: NDArray[np.float64], scale: NDArray[np.float64]) -> NDArray[np.float32]:
    return (fields / scale[:, None]).reshape(len(fields), -1).astype(np.float32)
