# SPDX-License-Identifier: GPL-3.0-or-later
"""Transfer of shares between grids, so that models of different cells can be compared."""

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import DataError
from bedchain.trajectory.grid import Grid


def regrid(shares: NDArray[np.floating], given: Grid, wanted: Grid) -> NDArray[np.float64]:
    """Shares in the cells of another grid of the same bed, if particles are spread evenly in each cell.

    Parameters
    ----------
    shares : (..., n_given) array
        Shares (or numbers) of particles in the cells of ``given`` [1].
    given, wanted : Grid
        Grid of the shares, and the other grid.

    Returns
    -------
    (..., n_wanted) array
        Shares in the cells of ``wanted`` [1]; their sum is unchanged.

    Raises
    ------
    DataError
        The grids are not of the same bed.
    """
    if not np.allclose((given.width_m, given.height_m), (wanted.width_m, wanted.height_m)):
        raise DataError(f"grids of two beds: {given} and {wanted}")
    table = np.asarray(shares, float).reshape(-1, given.rows, given.columns)
    along_x = _overlap(given.x_edges_m, wanted.x_edges_m)
    along_z = _overlap(given.z_edges_m, wanted.z_edges_m)
    transferred = np.einsum("nrc,rs,cd->nsd", table, along_z, along_x, optimize=True)
    return transferred.reshape(*np.shape(shares)[:-1], wanted.n_cells)


def _overlap(given: NDArray[np.float64], wanted: NDArray[np.float64]) -> NDArray[np.float64]:
    """Share of each given interval that lies in each wanted one, (n_given, n_wanted)."""
    low = np.maximum(given[:-1, None], wanted[None, :-1])
    high = np.minimum(given[1:, None], wanted[None, 1:])
    return np.maximum(high - low, 0.0) / np.diff(given)[:, None]
