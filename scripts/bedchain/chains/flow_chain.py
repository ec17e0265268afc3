# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain from solids that flow between cells: probabilities are flows over contents, not counted particles.

Over a time step a marked amount m of a cell with content V moves with the solids that leave it. Taken at the
end of the step (implicit, upwind), ``m_new (I - L dt) = m`` with ``L_ij = F_ij / V_i``: the inverse is a
stochastic matrix for every step, and where V follows its flows the content itself is carried exactly.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import splu

Array = NDArray[np.float64]
EMPTY = 1e-9  # least content of a cell, over the cell's volume: cells without solids hold nothing that moves
SUBSTEPS = 4  # of a frame: with twice as many the paper's axial curve changes by less than 0.005


class Fluxes(NamedTuple):
    """Contents and flows of a grid over a step.

    Attributes
    ----------
    before, after : (nz, nx) array
        Content of each cell [m3].
    right : (nz, nx - 1) array
        Flow through each face to the right [m3/s].
    up : (nz - 1, nx) array
        The same upwards.
    """

    before: Array
    after: Array
    right: Array
    up: Array


def generator(contents: Array, right: Array, up: Array) -> sparse.csc_array:
    """Rates L of leaving each cell for its neighbours, ``F_ij / V_i``, rows sum to 0 [1/s]."""
    cells = np.arange(contents.size).reshape(contents.shape)
    pairs = ((cells[:, :-1], cells[:, 1:], right), (cells[:-1], cells[1:], up))
    start = np.concatenate([np.where(flow > 0, low, high).ravel() for low, high, flow in pairs])
    end = np.concatenate([np.where(flow > 0, high, low).ravel() for low, high, flow in pairs])
    rate = np.concatenate([np.abs(flow).ravel() for _, _, flow in pairs]) / contents.ravel()[start]
    moves = sparse.coo_array((rate, (start, end)), shape=(contents.size, contents.size)).tocsc()
    return sparse.csc_array(moves - sparse.diags_array(moves.sum(axis=1)))


def carried(marked: Array, fluxes: Fluxes, duration_s: float, substeps: int = SUBSTEPS) -> Array:
    """Marked amounts after a step.

    Parameters
    ----------
    marked : (n_groups, n_cells) array
        Amount of each group in each cell [m3].
    fluxes : Fluxes
    duration_s : float
        Of the step [s].
    substeps : int
        Parts that the step is cut into.

    Returns
    -------
    (n_groups, n_cells) ndarray
        Each group's sum is kept to round-off.
    """
    identity, step = sparse.eye_array(fluxes.after.size, format="csc"), duration_s / substeps
    for part in range(1, substeps + 1):
        now = fluxes.before + (fluxes.after - fluxes.before) * part / substeps
        rates = generator(now, fluxes.right, fluxes.up)
        marked = splu(sparse.csc_array((identity - step * rates).T)).solve(marked.T).T
    return marked


def contents_of(solids: Array, volume_m3: float) -> Array:
    """Contents of cells from shares of solids, at least `EMPTY` of the cell [m3]."""
    return np.maximum(solids, EMPTY) * volume_m3


def remaining(
    start: Array, steps: Callable[[int], Fluxes], count: int, duration_s: float, sides: Array
) -> Array:
    """Share of each group that is still on its side, as of `measures.mixing.GROUPS`.

    Parameters
    ----------
    start : (nz, nx) array
        Contents at the start [m3].
    steps : callable
        Gives the fluxes of step 0, 1, ...
    count : int
        Steps.
    duration_s : float
        Of a step [s].
    sides : (n_groups, n_cells) array
        Share of each cell that lies on the side of a group [1].

    Returns
    -------
    (count + 1, n_groups) ndarray
        1 at step 0.
    """
    marked = sides * start.ravel()
    whole, rows = marked.sum(axis=1), []
    for at in range(count + 1):
        # of a cell that the line cuts the part on the group's side counts, as far as it is mixed; at the
        # start all of the group is there
        rows.append(np.ones(len(sides)) if at == 0 else (marked * sides).sum(axis=1) / whole)
        if at < count:
            marked = carried(marked, steps(at), duration_s)
    return np.array(rows)
