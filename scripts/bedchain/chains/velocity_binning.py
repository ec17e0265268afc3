# SPDX-License-Identifier: GPL-3.0-or-later
"""Velocities of particles, and velocity classes of equally many particles."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import DataError
from bedchain.trajectory.frames import Frames

# Quantiles are taken of about this many velocities: as accurate as of all, in a fraction of the time.
QUANTILE_SAMPLES = 1_000_000


def measured(frames: Frames) -> bool:
    """True if the frames hold velocities; None, or NaN of particles that are there, are none."""
    velocity, seen = (frames.vx_m_s, frames.vz_m_s), np.asarray(frames.cells[-1]) >= 0
    return all(part is not None and not np.isnan(part[-1][seen]).any() for part in velocity)


def velocities(frames: Frames) -> tuple[NDArray[np.floating], NDArray[np.floating]]:
    """Velocities of the frames or, where they hold none, from differences of positions.

    A difference is taken from the frame before, over the time between the two frames; the first frame has
    the velocities of the second.

    Returns
    -------
    vx_m_s, vz_m_s : (n_frames, n_particles) array
        [m/s].

    Raises
    ------
    DataError
        No velocities, and a single frame.
    """
    if measured(frames):
        assert frames.vx_m_s is not None and frames.vz_m_s is not None
        return frames.vx_m_s, frames.vz_m_s
    if len(frames.times_s) < 2:
        raise DataError(
            "a single frame without velocities: give the frame before it too, for velocities from "
            "differences of positions, or write the frames with velocities"
        )
    vx, vz = (np.diff(place, axis=0) / frames.interval_s for place in (frames.x_m, frames.z_m))
    return np.concatenate((vx[:1], vx)), np.concatenate((vz[:1], vz))


@dataclass(frozen=True)
class VelocityClasses:
    """Classes of the velocity (vx, vz), numbered ``class along x * n_z + class along z``.

    With ``back`` > 0 the velocity so many frames earlier counts too: present class * n_x n_z + earlier class.

    Parameters
    ----------
    edges_x_m_s, edges_z_m_s : (n_x - 1,), (n_z - 1,) array
        Rising velocities between the classes [m/s]; an edge belongs to the class above it.
    back : int
        Frames between the earlier and the present velocity [1]; 0 for the present one alone.
    """

    edges_x_m_s: NDArray[np.float64]
    edges_z_m_s: NDArray[np.float64]
    back: int = 0

    @property
    def number(self) -> int:
        """Number of classes, n_x n_z or its square [1]."""
        return self._n_present * (self._n_present if self.back else 1)

    @property
    def _n_present(self) -> int:
        return (self.edges_x_m_s.size + 1) * (self.edges_z_m_s.size + 1)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """The classes as plain arrays, for `from_arrays`."""
        return {"edges_x": self.edges_x_m_s, "edges_z": self.edges_z_m_s, "back": np.array(self.back)}

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> "VelocityClasses":
        """Classes from the arrays of `arrays`."""
        return cls(arrays["edges_x"], arrays["edges_z"], int(arrays["back"]))

    def of(self, frames: Frames) -> NDArray[np.int32]:
        """Class of each particle in each frame from number ``back`` on, by `velocities`.

        Returns
        -------
        (n_frames - back, n_particles) int32 array
        """
        classes = np.empty(frames.cells.shape, np.int32)
        for row, (vx, vz) in enumerate(zip(*velocities(frames), strict=True)):
            along_x = np.searchsorted(self.edges_x_m_s, vx, side="right")
            along_z = np.searchsorted(self.edges_z_m_s, vz, side="right")
            classes[row] = along_x * (self.edges_z_m_s.size + 1) + along_z
        if self.back:
            return np.asarray(classes[self.back :] * np.int32(self._n_present) + classes[: -self.back])
        return classes


def quantile_classes(frames: Frames, number: Sequence[int], back: int = 0) -> VelocityClasses:
    """Classes with equally many particles along each axis, over all frames of a window.

    Parameters
    ----------
    frames : Frames
        The learning window.
    number : (n_x, n_z)
        Classes along x and z [1].
    back : int
        As `VelocityClasses`.

    Returns
    -------
    VelocityClasses

    Raises
    ------
    DataError
        Fewer than one class along an axis, or other than two numbers.
    """
    if len(number) != 2 or min(number) < 1:
        raise DataError(f"velocity classes {list(number)}: give two numbers, along x and z, each at least 1")
    stride = max(1, frames.cells.size // QUANTILE_SAMPLES)
    edges = []
    for values, n in zip(velocities(frames), number, strict=True):
        # Every stride-th particle, beginning at another particle in each frame: all particles are sampled.
        sample = np.concatenate([now[frame % stride :: stride] for frame, now in enumerate(values)])
        sample = sample[~np.isnan(sample)].astype(np.float64)
        edges.append(np.quantile(sample, np.arange(1, n) / n))
    return VelocityClasses(edges[0], edges[1], back)
