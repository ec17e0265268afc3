# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of other programs in the axes and metres of the bed, particles by id."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from bedchain.errors import UserError
from bedchain.trajectory.dumps import listed
from bedchain.trajectory.forms.raw import POSITION, Columns
from bedchain.trajectory.frame_files import Entry, FrameSettings, radii


@dataclass(frozen=True)
class Placement:
    """Where the bed is in the frames.

    Parameters
    ----------
    across, up : str
        Axes of the files that become x and z of the bed: x, y or z, or -x, -y, -z.
    origin_m : tuple of float
        Left, front, bottom corner of the bed in the frames, along its own x, y and z [m].
    width_m, height_m : float
        Size of the bed [m].
    outside : str
        ``refuse`` particles outside the bed and such as come and go, or take them as an ``exit``.
    keep_depth : bool
        Whether the third axis is stored.
    without_ids : str
        ``refuse``; ``order``: the order in the file is the particle; ``one_tracer``: all rows are of one
        tracer, and those of one time become their mean.
    periods_m : tuple of float
        Length along the bed's x, y and z after which the frames repeat [m], 0 where they do not: a particle
        beyond such a side is put back at the other one.
    """

    across: str
    up: str
    origin_m: tuple[float, float, float]
    width_m: float
    height_m: float
    outside: str = "refuse"
    keep_depth: bool = False
    without_ids: str = "refuse"
    periods_m: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def axes(self) -> tuple[str, str, str]:
        """Axes of the files for x, y and z of the bed."""
        depth = next(name for name in POSITION if name not in (self.across[-1], self.up[-1]))
        return self.across, depth, self.up


class BedFrame(NamedTuple):
    """A frame in the bed's axes, particles by id.

    Attributes
    ----------
    ids : (n_particles,) ndarray of int64
    rows : (n_rows, n_particles) ndarray
        x, z, vx, vz and, where it is kept, y [m, m/s].
    type, radius_m : (n_particles,) ndarray or None
    """

    ids: np.ndarray
    rows: np.ndarray
    type: np.ndarray | None
    radius_m: np.ndarray | None


def place_of(entry: Entry) -> str:
    """File and step of a frame, for messages."""
    return entry.file if entry.step is None else f"{entry.file}, step {entry.step}"


def bed_frame(values: Columns, settings: FrameSettings, placement: Placement, place: str) -> BedFrame:
    """A frame in the bed's axes and metres, sorted by id.

    Parameters
    ----------
    values : dict of str to (n_particles,) array
        In axes and units of the files.
    settings : FrameSettings
    placement : Placement
    place : str
        File and step, for messages.

    Raises
    ------
    UserError
        An axis or the ids are missing, a value is not finite, or an id is there twice.
    """
    across, depth, up = placement.axes
    for axis in {across[-1], up[-1]} | ({depth} if placement.keep_depth else set()):
        if axis not in values:
            raise UserError(f"{place}: there is no position {axis}; there are {', '.join(values)}")
    if placement.without_ids == "one_tracer" and "id" not in values:
        values = {name: np.array([column.mean()]) for name, column in values.items()}
    ids = _ids(values, placement, place)
    order = None if bool((ids[1:] > ids[:-1]).all()) else np.argsort(ids, kind="stable")
    ids = ids if order is None else ids[order]
    if doubled := listed(np.unique(ids[1:][ids[1:] == ids[:-1]])):
        raise UserError(f"{place}: two particles have the id {doubled}")
    length, speed = settings.length_unit_m, settings.length_unit_m / settings.time_unit_s
    parts = [(across, "", 0), (up, "", 2), (across, "v", None), (up, "v", None)]
    parts += [(depth, "", 1)] if placement.keep_depth else []
    rows = np.empty((len(parts), ids.size))
    for row, (axis, prefix, origin) in enumerate(parts):
        column = values.get(prefix + axis[-1])
        if column is None:
            rows[row] = np.nan
            continue
        factor = (speed if prefix else length) * (-1 if axis.startswith("-") else 1)
        column = column if order is None else column[order]
        np.multiply(column, factor, out=rows[row])
        if origin is not None and placement.origin_m[origin]:
            rows[row] -= placement.origin_m[origin]
        if origin is not None and placement.periods_m[origin]:
            rows[row] %= placement.periods_m[origin]
        _check_finite(rows[row], ids, prefix + axis[-1], place)
    kind = values.get("type")
    radius = radii(values) * length if {"radius", "diameter"} & values.keys() else None
    if order is not None:
        kind, radius = (None if array is None else array[order] for array in (kind, radius))
    return BedFrame(ids, rows, None if kind is None else _whole(kind, "type", place), radius)


def _check_finite(row: np.ndarray, ids: np.ndarray, name: str, place: str) -> None:
    # the sum is finite only where each value is, but for overflow, which the slow test then sees
    if np.isfinite(row.sum()):
        return
    wrong = ~np.isfinite(row.astype(np.float32))
    if wrong.any():
        raise UserError(
            f"{place}: {name} of {wrong.sum()} particles is no finite number: id {listed(ids[wrong])}"
        )


def _ids(values: Columns, placement: Placement, place: str) -> np.ndarray:
    if "id" in values:
        return _whole(values["id"], "id", place)
    number = len(next(iter(values.values())))
    if number > 1 and placement.without_ids == "refuse":
        raise UserError(
            f"{place}: no column of ids, so a particle cannot be followed; where each frame lists the same "
            "particles in the same order, say frames.without_ids: order; where all rows are of one tracer, "
            "one_tracer"
        )
    return np.arange(1, number + 1)


def _whole(values: np.ndarray, name: str, place: str) -> np.ndarray:
    """Whole numbers of a column that may have been read as decimal ones."""
    if values.dtype.kind in "iu":
        return values.astype(np.int64)
    with np.errstate(invalid="ignore"):
        whole = values.astype(np.int64)
    if not np.array_equal(whole, values):
        wrong = values[whole != values][0]
        raise UserError(f"{place}: the {name} {wrong:g} is not a whole number")
    return whole
