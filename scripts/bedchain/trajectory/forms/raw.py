# SPDX-License-Identifier: GPL-3.0-or-later
"""A frame as a file has it: its header, and a call that reads its particles by names that all forms share."""

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from bedchain.errors import DataError

Columns = dict[str, np.ndarray]

# our name -> names in files, in lower case without blanks, marks and units, the first that is there
ALIASES = {
    "id": ("id", "particleid", "globalid", "pid", "ids"),
    "type": ("type", "phaseid", "particletype", "materialid", "species"),
    "radius": ("radius", "r", "particleradius"),
    "diameter": ("diameter", "d", "particlediameter"),
    "x": ("x", "xu", "xs", "xsu", "posx", "positionx", "coordx", "points0"),
    "y": ("y", "yu", "ys", "ysu", "posy", "positiony", "coordy", "points1"),
    "z": ("z", "zu", "zs", "zsu", "posz", "positionz", "coordz", "points2"),
    "vx": ("vx", "u", "velx", "velocityx", "v0", "velocity0"),
    "vy": ("vy", "v", "vely", "velocityy", "v1", "velocity1"),
    "vz": ("vz", "w", "velz", "velocityz", "v2", "velocity2"),
    "time": ("time", "t", "times"),
    "step": ("step", "timestep", "frame"),
}
PARTICLE = ("id", "type", "radius", "diameter", "x", "y", "z", "vx", "vy", "vz")
POSITION = ("x", "y", "z")


class CutOffError(DataError):
    """A frame that ends before its last particle, as a killed run leaves one."""


class RawFrame(NamedTuple):
    """A frame in a file.

    Attributes
    ----------
    columns : tuple of str
        Its columns of `PARTICLE`, by our names.
    load : callable
        Gives the values of these columns by name, (n_particles,) arrays in the file's units; raises
        `DataError`.
    step : int, optional
        DEM step.
    time : float, optional
        Time in the file's unit.
    number : int, optional
        Particles that the header announces.
    box : (3, 2) ndarray, optional
        Lower and upper bound in x, y and z.
    periodic : tuple of bool
        Of the sides in x, y and z.
    """

    columns: tuple[str, ...]
    load: Callable[[], Columns]
    step: int | None = None
    time: float | None = None
    number: int | None = None
    box: np.ndarray | None = None
    periodic: tuple[bool, ...] = (False, False, False)


def plain(name: str) -> str:
    """A column's name in lower case, without unit and marks: ``"Position X (m)"`` becomes ``positionx``."""
    name = name.split("[")[0].split("(")[0].strip().lower()
    if name == "t_s":
        return name  # MFiX: the temperature of a solid
    if name.startswith("c_") or name.startswith("f_"):
        return name  # computed by a command of the deck, such as its own unwrapped positions
    for unit in ("_m_s", "_m", "_s", "_mm", "_ms"):
        name = name.removesuffix(unit)
    return "".join(letter for letter in name if letter.isalnum())


def our_columns(names: Sequence[str], renamed: Mapping[str, str] | None = None) -> dict[str, int]:
    """Places of the columns that are of use, by our names.

    Parameters
    ----------
    names : sequence of str
        Of the columns in the file, in order.
    renamed : mapping of str to str, optional
        Our name -> name in the file, before any guess.

    Returns
    -------
    dict of str to int

    Raises
    ------
    DataError
        A renamed column is not there.
    """
    places: dict[str, int] = {}
    for name, theirs in (renamed or {}).items():
        if theirs not in names:
            raise DataError(
                f"there is no column {theirs!r} for {name} (frames.columns); there are {' '.join(names)}"
            )
        places[name] = list(names).index(theirs)
    seen = [plain(name) for name in names]
    for name, aliases in ALIASES.items():
        for alias in aliases:
            if name not in places and alias in seen:
                places[name] = seen.index(alias)
    if "v" in seen and "u" not in seen and "vy" not in seen and (renamed or {}).get("vy") is None:
        places.pop("vy", None)  # a column v alone is a speed
    return places


def unscaled(values: Columns, names: Sequence[str], box: np.ndarray | None) -> Columns:
    """Positions given as shares of the box (xs, xsu) in the box's own unit.

    Raises
    ------
    DataError
        There is no box.
    """
    for axis, name in enumerate(POSITION):
        scaled = any(other in names for other in (f"{name}s", f"{name}su"))
        if name not in values or not scaled or name in names or f"{name}u" in names:
            continue
        if box is None:
            raise DataError(f"{name}s are shares of a box, and the frame has none")
        values[name] = box[axis, 0] + values[name] * (box[axis, 1] - box[axis, 0])
    return values
