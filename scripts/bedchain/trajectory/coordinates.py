# SPDX-License-Identifier: GPL-3.0-or-later
"""Coordinates that cells are equal steps of: along a box, or around the axis of a cylinder; all lengths.

| form | columns | rows | layers |
|---|---|---|---|
| boxes | x | z | y |
| rings, vertical axis | r | z | - |
| rings, horizontal axis | r | y | - |
| sectors, vertical axis | arc | z | r |
| sectors, horizontal axis | arc | r | y |

The arc is the angle times the radius of the cylinder. About a horizontal axis, along y, it starts at the top
and goes by -x to the bottom and on by +x; about a vertical one it starts at +x and goes by -y to -x and +y.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bedchain.errors import DataError

Array = NDArray[Any]
# width, height and depth may differ by so much of the width in a cylinder
ROUND = 1e-3
ROUND_OFF = 1e-6


class Size(NamedTuple):
    """Size of the bed along x, z and y [m]; the depth is 0 where nothing needs it."""

    width_m: float
    height_m: float
    depth_m: float


class Coordinates(NamedTuple):
    """Coordinates of the columns, rows and layers of a partition.

    Attributes
    ----------
    names : tuple of str
        Of the columns', the rows' and the layers' coordinate; empty where there is none.
    lengths : callable
        From a `Size` to the lengths of the three [m].
    of : callable
        From positions x, z, y [m] and a `Size` to the three coordinates [m].
    place : callable
        From the three coordinates [m] and a `Size` to positions x, z, y [m]; at angle 0 for rings.
    uses_y : tuple of bool
        Whether the columns', the rows' and the layers' coordinate needs y.
    """

    names: tuple[str, str, str]
    lengths: Callable[[Size], tuple[float, float, float]]
    of: Callable[[Array, Array, Array, Size], tuple[Array, Array, Array]]
    place: Callable[[Array, Array, Array, Size], tuple[Array, Array, Array]]
    uses_y: tuple[bool, bool, bool]


def _round(across: Array, along: Array, radius: float) -> tuple[Array, Array]:
    """Distance from the axis, and the arc at the wall, of places relative to the axis [m]."""
    # in float64, and a wall that is a round-off beyond itself is still the wall
    distance = np.hypot(np.asarray(across, np.float64), np.asarray(along, np.float64))
    return distance, radius * (np.arctan2(across, -along) + np.pi)


def _from_z(x: Array, z: Array, y: Array, size: Size) -> tuple[Array, Array, Array]:
    radius = size.width_m / 2
    distance, arc = _round(y - size.depth_m / 2, x - radius, radius)
    return arc, z, distance


def _from_y(x: Array, z: Array, y: Array, size: Size) -> tuple[Array, Array, Array]:
    radius = size.width_m / 2
    distance, arc = _round(x - radius, z - size.height_m / 2, radius)
    return arc, distance, y


def _to_z(arc: Array, z: Array, distance: Array, size: Size) -> tuple[Array, Array, Array]:
    radius = size.width_m / 2
    angle = arc / radius - np.pi
    return radius - distance * np.cos(angle), z, size.depth_m / 2 + distance * np.sin(angle)


def _to_y(arc: Array, distance: Array, y: Array, size: Size) -> tuple[Array, Array, Array]:
    radius = size.width_m / 2
    angle = arc / radius - np.pi
    return radius + distance * np.sin(angle), size.height_m / 2 - distance * np.cos(angle), y


def _rings_from_z(x: Array, z: Array, y: Array, size: Size) -> tuple[Array, Array, Array]:
    arc, height, distance = _from_z(x, z, y, size)
    return distance, height, arc


def _rings_from_y(x: Array, z: Array, y: Array, size: Size) -> tuple[Array, Array, Array]:
    arc, distance, depth = _from_y(x, z, y, size)
    return distance, depth, arc


def _turn(size: Size) -> float:
    return float(np.pi * size.width_m)


COORDINATES: dict[tuple[str, str], Coordinates] = {
    ("boxes", "vertical"): Coordinates(
        ("x", "z", "y"),
        lambda size: (size.width_m, size.height_m, size.depth_m),
        lambda x, z, y, _: (x, z, y),
        lambda x, z, y, _: (x, z, y),
        (False, False, True),
    ),
    ("rings", "vertical"): Coordinates(
        ("r", "z", ""),
        lambda size: (size.width_m / 2, size.height_m, _turn(size)),
        _rings_from_z,
        lambda r, z, arc, size: _to_z(arc, z, r, size),
        (True, False, True),
    ),
    ("rings", "horizontal"): Coordinates(
        ("r", "y", ""),
        lambda size: (size.width_m / 2, size.depth_m, _turn(size)),
        _rings_from_y,
        lambda r, y, arc, size: _to_y(arc, r, y, size),
        (False, True, False),
    ),
    ("sectors", "vertical"): Coordinates(
        ("arc", "z", "r"),
        lambda size: (_turn(size), size.height_m, size.width_m / 2),
        _from_z,
        _to_z,
        (True, False, True),
    ),
    ("sectors", "horizontal"): Coordinates(
        ("arc", "r", "y"),
        lambda size: (_turn(size), size.width_m / 2, size.depth_m),
        _from_y,
        _to_y,
        (False, False, True),
    ),
}


def coordinates_of(form: str, axis: str, size: Size) -> Coordinates:
    """Coordinates of a form of cells.

    Parameters
    ----------
    form : {"boxes", "rings", "sectors"}
    axis : {"vertical", "horizontal"}
        Of the cylinder.
    size : Size
        Of the bed.

    Raises
    ------
    DataError
        There is no such form, or the bed is not round about the axis.
    """
    if (form, axis) not in COORDINATES:
        forms = ", ".join(f"{form} ({axis})" for form, axis in COORDINATES)
        raise DataError(f"no cells of the form {form} ({axis}): choose from {forms}")
    other = size.depth_m if axis == "vertical" else size.height_m
    if form != "boxes" and abs(size.width_m - other) > ROUND * size.width_m:
        name = "deep" if axis == "vertical" else "high"
        raise DataError(
            f"{form} about a {axis} axis in a bed {size.width_m:g} m wide and {other:g} m {name}: it must be "
            f"as {name} as wide, the box around its cylinder"
        )
    return COORDINATES[form, axis]


def limit_of(form: str, length_m: float, values: Array) -> float:
    """Largest value inside: the wall as it is stored, or up to the round-off of a distance [m]."""
    if form != "boxes":
        return length_m * (1 + ROUND_OFF)
    dtype = values.dtype if np.issubdtype(values.dtype, np.floating) else np.float64
    return max(length_m, float(np.asarray(length_m, dtype=dtype)))


def check_inside(
    names: Sequence[str],
    coordinates: Sequence[Array],
    lengths_m: Sequence[float],
    form: str,
    first_frame: int,
) -> None:
    """Refuse particles outside the bed.

    Parameters
    ----------
    names : sequence of str
        Of the coordinates.
    coordinates : sequence of (n_particles,) or (n_frames, n_particles) array
        [m].
    lengths_m : sequence of float
        Largest value of each [m].
    form : str
        Of the cells.
    first_frame : int
        Number of the first frame, for the message.

    Raises
    ------
    DataError
        The first such particle is named, with its frame and distance.
    """
    for name, values, top in zip(names, coordinates, lengths_m, strict=False):
        limit = limit_of(form, top, values)
        if values.size == 0 or (values.min() >= 0 and values.max() <= limit):
            continue
        index = tuple(int(i) for i in np.argwhere(~((values >= 0) & (values <= limit)))[0])
        value = float(values[index])
        excess = -value if value < 0 else value - top
        frame = first_frame + (index[0] if len(index) > 1 else 0)
        raise DataError(
            f"particle {index[-1]} (counted from 0) in frame {frame} is at {name} = {value:g} m, "
            f"{excess:g} m outside the bed (0 to {top:g} m): check the bed's size in the case file, "
            "or whether particles leave the bed"
        )
