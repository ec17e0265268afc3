# SPDX-License-Identifier: GPL-3.0-or-later
"""Profiles across the bed, averaged over boxes as in measurements.

A measured point is an average over a box (a strip along x, a slice along z, the whole depth) and over time.
The voidage is 1 minus the volume of the spheres in the box over that of the box. The velocity is the mean
over the solid volume in the box: the signal of magnetic resonance comes from the material of the particles.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

QUANTITIES = {"voidage_1": ("voidage", "1"), "particle_velocity_m_s": ("particle_velocity", "m/s")}


class Boxes(NamedTuple):
    """Boxes side by side along x, at one height, through the whole depth.

    Attributes
    ----------
    x_low_m, x_high_m : (n_boxes,) ndarray
        Left and right sides [m].
    z_low_m, z_high_m : float
        Bottom and top of the slice [m].
    depth_m : float
        Size along y [m].
    """

    x_low_m: np.ndarray
    x_high_m: np.ndarray
    z_low_m: float
    z_high_m: float
    depth_m: float

    @property
    def volumes_m3(self) -> np.ndarray:
        """Volume of each box [m3]."""
        return (self.x_high_m - self.x_low_m) * (self.z_high_m - self.z_low_m) * self.depth_m


def boxes_around(
    positions_m: np.ndarray, strip_m: float, height_m: float, slice_m: float, width_m: float, depth_m: float
) -> Boxes:
    """Boxes with their centres at given positions, cut off at the side walls.

    Parameters
    ----------
    positions_m : (n_boxes,) ndarray
        Centres along x [m].
    strip_m, slice_m : float
        Size of a box along x and z [m].
    height_m : float
        Middle of the slice [m].
    width_m, depth_m : float
        Of the bed [m].
    """
    low, high = (np.clip(positions_m + side * strip_m / 2, 0, width_m) for side in (-1, 1))
    return Boxes(low, high, height_m - slice_m / 2, height_m + slice_m / 2, depth_m)


def share_between(centres: np.ndarray, radius: float, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Share of each sphere's volume between two planes [1].

    The volume below a plane at a distance ``t r`` from the centre is ``(2 + 3 t - t^3) / 4`` of the sphere
    (spherical cap). The arguments broadcast.
    """
    below = [(2 + 3 * t - t**3) / 4 for t in (np.clip((x - centres) / radius, -1, 1) for x in (low, high))]
    return np.asarray(below[1] - below[0])


def solids_in_boxes(
    x_m: np.ndarray, z_m: np.ndarray, vz_m_s: np.ndarray, radius_m: float, boxes: Boxes
) -> NDArray[np.float64]:
    """Volume of spheres in each box, and its vertical momentum over the density, in a frame.

    A sphere cut by a side and by the bottom or top of a box counts with the product of both shares: its
    volume in the box on average over heights, exact where the density does not change within a diameter.

    Parameters
    ----------
    x_m, z_m : (n_particles,) ndarray
        Centres [m].
    vz_m_s : (n_particles,) ndarray
        Vertical velocities [m/s].
    radius_m : float
        Radius of a sphere [m].
    boxes : Boxes

    Returns
    -------
    (2, n_boxes) ndarray
        Volume [m3], and volume times velocity [m4/s].
    """
    near = (z_m > boxes.z_low_m - radius_m) & (z_m < boxes.z_high_m + radius_m)
    x, z, vz = (np.asarray(values[near], float) for values in (x_m, z_m, vz_m_s))
    in_slice = share_between(z, radius_m, np.array(boxes.z_low_m), np.array(boxes.z_high_m))
    in_strip = share_between(x[:, None], radius_m, boxes.x_low_m, boxes.x_high_m)
    volume = 4 / 3 * np.pi * radius_m**3
    return volume * (np.stack([in_slice, in_slice * vz]) @ in_strip)


def profile(quantity: str, solids: NDArray[np.float64], boxes: Boxes) -> NDArray[np.float64]:
    """Voidage [1] or particle velocity [m/s] of each box, from the time mean of `solids_in_boxes`.

    Parameters
    ----------
    quantity : str
        Of `QUANTITIES`.
    solids : (..., 2, n_boxes) ndarray
        Means over frames.
    boxes : Boxes

    Returns
    -------
    (..., n_boxes) ndarray
        The velocity is NaN where no particle was.
    """
    volume, momentum = solids[..., 0, :], solids[..., 1, :]
    if quantity == "voidage_1":
        return 1 - volume / boxes.volumes_m3
    return np.divide(momentum, volume, out=np.full_like(volume, np.nan), where=volume > 0)
