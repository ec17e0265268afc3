# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory of the motion that the place of a particle does not explain: the error of a chain at its steps.

Walls turn displacements back, so that the dispersion over a lag falls before the velocity is forgotten. A
chain knows the walls, since it knows the cell. What it lacks is the correlation of the displacement before a
moment with the one after it, among particles at the same place at that moment; for a Markov chain it is 0.
"""

import numpy as np
from numpy.typing import NDArray

from bedchain.measures.dispersion_by_lag import MOST_ORIGINS

Array = NDArray[np.float64]

PARTS = 8  # of the particles' places along each axis, equally full: 64 places


def remaining_memory(places_m: Array, lag: int) -> Array:
    """Correlation of successive displacements among particles at the same place, by axis.

    Parameters
    ----------
    places_m : (2, n_frames, n_particles) array
        Positions along x and z [m], such as those of `dispersion_by_lag.thinned`.
    lag : int
        Length of a displacement [frames]; two of them must fit into the frames.

    Returns
    -------
    (2,) array
        [1]; 0 along an axis without motion.
    """
    room = places_m.shape[1] - 2 * lag
    origins = np.unique(np.linspace(0, room - 1, min(room, MOST_ORIGINS)).round().astype(int))
    before, now, after = (places_m[:, origins + shift * lag] for shift in range(3))
    parts = [_part(axis.ravel()) for axis in now]
    place = parts[0] * PARTS + parts[1]
    first, second = ((step.reshape(2, -1)) for step in (now - before, after - now))
    memory = np.zeros(2)
    for axis in range(2):
        one, other = (step[axis] - _means(step[axis], place) for step in (first, second))
        spread = np.sqrt(first[axis].var() * second[axis].var())
        memory[axis] = float((one * other).mean() / spread) if spread > 0 else 0.0
    return memory


def _part(position: Array) -> NDArray[np.int64]:
    """Number of the part of equally many positions that each lies in."""
    edges = np.quantile(position[:: max(1, position.size // 10000)], np.arange(1, PARTS) / PARTS)
    return np.asarray(np.searchsorted(edges, position), np.int64)


def _means(step: Array, place: NDArray[np.int64]) -> Array:
    """Mean step at the place of each particle."""
    number = np.maximum(np.bincount(place, minlength=PARTS**2), 1)
    return np.asarray((np.bincount(place, step, PARTS**2) / number)[place])
