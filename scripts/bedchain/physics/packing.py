# SPDX-License-Identifier: GPL-3.0-or-later
"""A bed at rest: its height and voidage, thickness of a slab of one layer, what friction on walls carries."""

import math


def slab_voidage(area_share: float, thickness_diameters: float) -> float:
    """Voidage of one layer of spheres in a slab [1].

    Parameters
    ----------
    area_share : float
        Share of the plane that the spheres cover as discs [1].
    thickness_diameters : float
        Thickness of the slab over the diameter [1]; 1 in Xu, Yu 1997, Chem. Eng. Sci. 52, 2785.
    """
    return 1 - 2 / 3 * area_share / thickness_diameters


def converted_thickness(area_share: float) -> float:
    """Thickness that gives the voidage of Hoomans et al. 1996, Chem. Eng. Sci. 51, 99, in diameters [1].

    ``1 - e = 2 / sqrt(pi sqrt(3)) (1 - e_plane)^1.5`` converts a voidage in the plane to one in space.
    Closest-packed discs become closest-packed spheres, as with `LAYER_DISTANCE`.

    Parameters
    ----------
    area_share : float
        ``1 - e_plane`` [1].
    """
    solids = 2 / math.sqrt(math.pi * math.sqrt(3)) * area_share**1.5
    return 2 / 3 * area_share / solids


PACKED_AREA_SHARE = 0.82  # of the plane, covered by random close-packed discs
PACKED_VOLUME_SHARE = 0.6  # of space, filled by settled spheres: between random loose and random close
START_SPACING_DIAMETERS = 1.15  # of the lattice that the particles fall from: no contact at the start
# Distance between layers of closest-packed spheres, in diameters. In a slab of this thickness closest discs
# (0.907 of the plane) have the voidage of closest spheres (0.740 of space).
LAYER_DISTANCE = math.sqrt(2 / 3)


def settled_height(number: int, diameter: float, width: float, depth: float | None = None) -> float:
    """Height of the settled bed [m], estimated by random packing.

    Parameters
    ----------
    number : int
        Number of particles [1].
    diameter, width : float
        Of a particle and of the bed [m].
    depth : float, optional
        Distance of the front and back walls [m]; None for a bed of one layer.
    """
    if depth is None:
        return number * math.pi * diameter**2 / 4 / (PACKED_AREA_SHARE * width)
    return number * math.pi * diameter**3 / 6 / (PACKED_VOLUME_SHARE * width * depth)


def start_height(number: int, diameter: float, width: float, depth: float | None = None) -> float:
    """Height of the lattice that the particles fall from in ``in.settle`` [m].

    Parameters
    ----------
    number, diameter, width, depth
        As in `settled_height`; width and depth are at least one lattice spacing.
    """
    spacing = START_SPACING_DIAMETERS * diameter
    columns = math.floor(width / spacing)
    layers = 1 if depth is None else math.floor(depth / spacing)
    return math.ceil(number / (columns * layers)) * width / columns


def wall_share(slimness: float) -> float:
    """Share of a bed's weight that friction on its walls carries [1], by Janssen 1895.

    Parameters
    ----------
    slimness : float
        Wall friction times stress ratio times wall area over cross section,
        ``2 mu K h / W`` for two walls [1].
    """
    return 1 + math.expm1(-slimness) / slimness if slimness > 0 else 0.0
