# SPDX-License-Identifier: GPL-3.0-or-later
"""Circulation of a chain in its long run: net fluxes between cells, and the entropy that they produce."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from bedchain.chains.markov_chain import MarkovChain

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Circulation:
    """How far a chain is from detailed balance, cell by cell.

    Parameters
    ----------
    flow_m_s : (n_cells, 2) array
        Half the sum over the other cells of net flux times distance, along x and z; divided by the share of
        the particles in the cell, their mean speed of circulation [m/s].
    density : (n_cells,) array
        Share of the particles in each cell [1].
    net_share : float
        Net flux over all flux between different cells, 0 in detailed balance and 1 where no particle goes
        back the way that others come [1].
    entropy_1_s : (n_cells,) array
        Entropy production of the links of each cell, half of ``(F_ij - F_ji) ln(F_ij / F_ji)`` for a link
        (Schnakenberg, Rev. Mod. Phys. 48 (1976) 571), in units of Boltzmann's constant [1/s]. Links that
        particles took one way only, whose entropy would be infinite, do not count.
    one_way_share : float
        Share of the flux between different cells on such links [1].
    """

    flow_m_s: Array
    density: Array
    net_share: float
    entropy_1_s: Array
    one_way_share: float


def circulation(chain: MarkovChain, density: Array) -> Circulation:
    """Net fluxes between cells.

    Parameters
    ----------
    chain : MarkovChain
        Fluxes of several states in a cell are summed: their entropy production is a lower bound.
    density : (n_states,) array
        Its long-run density [1].

    Returns
    -------
    Circulation
    """
    n_cells, lengths = chain.grid.n_cells, np.diff(chain.matrix.indptr)
    weights = np.repeat(density, lengths) * chain.matrix.data / chain.lag_s
    ends = (np.repeat(chain.cell_of_state, lengths), chain.cell_of_state[chain.matrix.indices])
    flux = sparse.coo_array((weights, ends), shape=(n_cells, n_cells)).tocsr()
    flux.setdiag(0.0)
    flux.eliminate_zeros()
    net = sparse.coo_array(flux - flux.T)
    origin, end = net.coords
    distance = chain.grid.centres_m[end] - chain.grid.centres_m[origin]
    # each net flux once, half of it for either end
    moved = 0.5 * np.maximum(net.data, 0) * distance.T
    flow = np.stack([np.bincount(at, along, n_cells) for along in moved for at in (origin, end)])
    flow = flow.reshape(2, 2, n_cells).sum(axis=1).T
    return Circulation(
        flow,
        np.bincount(chain.cell_of_state, density, n_cells).astype(np.float64),
        float(np.maximum(net.data, 0).sum() / max(flux.sum(), np.finfo(float).tiny)),
        *_entropy(sparse.coo_array(flux), n_cells),
    )


def _entropy(flux: sparse.coo_array, n_cells: int) -> tuple[Array, float]:
    """Entropy production by cell, and the share of the flux on links that go one way only."""
    back = sparse.csr_array(flux.T.tocsr())
    origin, end = flux.coords
    returned = np.asarray(back[origin, end]).ravel() if origin.size else np.zeros(0)
    both = returned > 0
    there, here = flux.data[both], returned[both]
    # each pair appears twice, from either end: half of it to each
    entropy = np.bincount(origin[both], 0.5 * (there - here) * np.log(there / here), n_cells)
    total = flux.data.sum()
    return entropy.astype(np.float64), float(flux.data[~both].sum() / total) if total else 0.0
