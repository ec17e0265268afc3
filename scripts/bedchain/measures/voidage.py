# SPDX-License-Identifier: GPL-3.0-or-later
"""Voidage of a one-layer bed by height."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Slab:
    """What the voidage of a slab of equal spheres depends on besides their places.

    Attributes
    ----------
    thickness_m, diameter_m : float
        Of the slab, of a particle [m].
    """

    thickness_m: float
    diameter_m: float


def profiles(
    z_m: NDArray[np.floating],
    edges_m: NDArray[np.float64],
    width_m: float,
    thickness_m: float,
    diameter_m: float,
) -> NDArray[np.float64]:
    """Voidage by height in each frame, 1 - (sphere volume) / (width dz T).

    Parameters
    ----------
    z_m : (n_frames, n_particles) array
        Heights [m].
    edges_m : (n_rows + 1,) array
        Edges of the rows [m].
    width_m, thickness_m, diameter_m : float
        Width of the bed, thickness of its slab, particle diameter [m].

    Returns
    -------
    (n_frames, n_rows) ndarray
        Voidage [1].
    """
    held = np.array([np.histogram(z, edges_m)[0] for z in z_m])
    volume = np.pi / 6 * diameter_m**3
    return np.asarray(1 - held * volume / (width_m * np.diff(edges_m) * thickness_m))
