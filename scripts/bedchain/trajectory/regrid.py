# SPDX-License-Identifier: GPL-3.0-or-later
"""Densities on one grid of cells brought to another, so that models of different cells can be compared."""

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import DataError
from bedchain.trajectory.grid import Grid


def regrid(shares: NDArray[np.floating], given: Grid, wanted: Grid) -> NDArray[np.float64]:
    """Shares in the cells of another grid of the same bed, particles spread evenly inside each cell.

    Parameters
    ----------
    shares : (..., n_given) array
        Shares (or numbers) of particles in the cells of ``given`` [1].
    given, wanted : Grid

    Returns
    -------
    (..., n_wanted) array
        With the same sums.

    Raises
    ------
    DataError
        The grids are not of one bed.
    """
    if not np.allclose((given.width_m, given.height_m), (wanted.width_m, wanted.height_m)):
        raise DataError(f"grids of two beds: {given} and {wanted}")
    table = np.asarray(shares, float).reshape(-1, given.rows, given.columns)
    along_x = _overlap(given.x_edges_m, wanted.x_edges_m)
    along_z = _overlap(given.z_edges_m, wanted.z_edges_m)
    found = np.einsum("nrc,rs,cd->nsd", table, along_z, along_x, optimize=True)
    return found.reshape(*np.shape(shares)[:-1], wanted.n_cells)


def _overlap(given: NDArray[np.float64], wanted: NDArray[np.float64]) -> NDArray[np.float64]:
    """Share of each given interval that lies in each wanted one, (n_given, n_wanted)."""
    low = np.maximum(given[:-1, None], wanted[None, :-1])
    high = np.minimum(given[1:, None], wanted[None, 1:])
    return np.maximum(high - low, 0.0) / np.diff(given)[:, None]
