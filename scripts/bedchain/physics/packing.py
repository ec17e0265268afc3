# SPDX-License-Identifier: GPL-3.0-or-later
"""Packing of spheres: height and voidage of a settled bed, thickness of a slab of one layer."""

import math


def slab_voidage(area_share: float, thickness_diameters: float) -> float:
    """Voidage of one layer of spheres in a slab [1].

    Parameters
    ----------
    area_share : float
        Part of the plane that the spheres cover as discs [1].
    thickness_diameters : float
        Thickness of the slab over the diameter [1]; one in Xu, Yu 1997, Chem. Eng. Sci. 52, 2785.
    """
    return 1 - 2 / 3 * area_share / thickness_diameters


def converted_thickness(area_share: float) -> float:
    """Thickness that gives the voidage of Hoomans et al. 1996, Chem. Eng. Sci. 51, 99, in diameters [1].

    ``1 - e = 2 / sqrt(pi sqrt(3)) (1 - e_plane)^1.5`` converts a voidage in the plane to one in space. It
    makes of closest discs closest spheres, as `LAYER_DISTANCE` does, and of looser discs looser spheres.

    Parameters
    ----------
    area_share : float
        ``1 - e_plane`` [1].
    """
    solids = 2 / math.sqrt(math.pi * math.sqrt(3)) * area_share**1.5
    return 2 / 3 * area_share / solids


PACKED_AREA_SHARE = 0.82  # area covered by one layer of random close-packed discs


PACKED_VOLUME_SHARE = 0.6  # volume filled by spheres after a fall, between random loose and random close


START_SPACING_DIAMETERS = 1.15  # of the loose lattice that the particles fall from: no contact at the start


# Distance of the layers of closest-packed spheres, in diameters: a slab as thick makes of closest discs,
# 0.907 of the plane, closest spheres, 0.740 of space
LAYER_DISTANCE = math.sqrt(2 / 3)


def settled_height(number: int, diameter: float, width: float, depth: float | None = None) -> float:
    """Height of the settled bed [m], an estimate by random packing.

    Parameters
    ----------
    number : int
        Particles [1].
    diameter, width : float
        Of a particle and of the bed [m].
    depth : float, optional
        Between the walls in front and behind [m]; without it the bed is one layer of discs.
    """
    if depth is None:
        return number * math.pi * diameter**2 / 4 / (PACKED_AREA_SHARE * width)
    return number * math.pi * diameter**3 / 6 / (PACKED_VOLUME_SHARE * width * depth)


def start_height(number: int, diameter: float, width: float, depth: float | None = None) -> float:
    """Height of the loose lattice that the particles fall from [m], as ``in.settle`` makes it.

    Parameters
    ----------
    number, diameter, width, depth
        As in `settled_height`; at least one lattice spacing fits into width and depth.
    """
    spacing = START_SPACING_DIAMETERS * diameter
    columns = math.floor(width / spacing)
    layers = 1 if depth is None else math.floor(depth / spacing)
    return math.ceil(number / (columns * layers)) * width / columns
