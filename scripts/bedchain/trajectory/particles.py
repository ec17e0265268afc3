# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties of the particles of a trajectory that do not change in time: ids, types, radii."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from bedchain.array_files import read_arrays
from bedchain.errors import DataError
from bedchain.files import write_arrays

PARTICLES = "particles.npz"


class Particles(NamedTuple):
    """Properties of the particles of a trajectory, which do not change in time.

    Attributes
    ----------
    ids : (n_particles,) ndarray of int64
        Ascending.
    type : (n_particles,) ndarray of int32, optional
        Kind of each particle, where the source has it.
    radius_m : (n_particles,) ndarray of float32, optional
        Radius of each particle [m], where the source has it.
    """

    ids: np.ndarray
    type: np.ndarray | None = None
    radius_m: np.ndarray | None = None


def write_particles(path: Path, particles: Particles) -> None:
    """Write ``particles.npz``, without the properties that are not there."""
    write_arrays(path, {name: array for name, array in particles._asdict().items() if array is not None})


def read_particles(trajectory: Path) -> Particles | None:
    """Properties of the particles beside a trajectory; None where there are none.

    Parameters
    ----------
    trajectory : Path
        ``trajectory.npy``.

    Returns
    -------
    Particles or None

    Raises
    ------
    DataError
        The file cannot be read, or holds something else.
    """
    path = trajectory.with_name(PARTICLES)
    if not path.exists():
        return None
    try:
        return Particles(**read_arrays(path))
    except TypeError as error:
        raise DataError(f"{path} holds no properties of particles ({error}): make it again") from error
