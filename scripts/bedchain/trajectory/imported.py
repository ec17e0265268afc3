# SPDX-License-Identifier: GPL-3.0-or-later
"""Somebody else's frames into the store: checked, moved to the bed's corner, a few in memory at a time."""

import json
import logging
from collections import deque
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, NamedTuple

import numpy as np
from tqdm import tqdm

from bedchain.errors import UserError
from bedchain.files import atomic_file, write_npy_header, write_text
from bedchain.trajectory.dumps import listed
from bedchain.trajectory.forms.raw import POSITION, Columns
from bedchain.trajectory.motion import MotionCheck
from bedchain.trajectory.particles import Particles, write_particles
from bedchain.trajectory.store import STORED, check_disk
from bedchain.trajectory.survey import Entry, FrameSettings, Survey, radii, raw_frames, values_of

LOG = logging.getLogger(__name__)

WORKERS = 2
AHEAD = 3  # frames in memory
SAME_RADIUS = 1e-3


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
        ``refuse``, or ``order``: the order in the file is the particle.
    """

    across: str
    up: str
    origin_m: tuple[float, float, float]
    width_m: float
    height_m: float
    outside: str = "refuse"
    keep_depth: bool = False
    without_ids: str = "refuse"

    @property
    def axes(self) -> tuple[str, str, str]:
        """Axes of the files for x, y and z of the bed."""
        depth = next(name for name in POSITION if name not in (self.across[-1], self.up[-1]))
        return self.across, depth, self.up


class Targets(NamedTuple):
    """Files to make: ``trajectory.npy``, ``trajectory.json``, ``particles.npz``."""

    trajectory: Path
    metadata: Path
    particles: Path


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


def write_imported(
    frames: Survey, settings: FrameSettings, placement: Placement, targets: Targets, progress: bool = True
) -> MotionCheck:
    """Write all frames of a survey as a trajectory.

    Parameters
    ----------
    frames : Survey
    settings : FrameSettings
    placement : Placement
    targets : Targets
        See `store` for what they hold.
    progress : bool
        Show a progress bar on stderr.

    Returns
    -------
    MotionCheck
        Displacements beside velocities.

    Raises
    ------
    UserError
        A frame cannot be read, is not finite, has doubled ids, another type of a particle than before,
        particles outside the bed, or other particles than the first (these two only where they are refused).
    """
    entries = frames.entries
    n_rows = len(STORED) + placement.keep_depth
    check_disk(targets.trajectory, 4 * n_rows * len(entries) * frames.number)
    keeper = _Keeper(placement)
    motion = MotionCheck()
    with ExitStack() as stack:
        raw = stack.enter_context(atomic_file(targets.trajectory.with_suffix(".part")))
        stream = stack.enter_context(raw.open("w+b"))
        bar = tqdm(total=len(entries), desc="import_frames", unit="frame", disable=not progress)
        for entry, values in _ahead(entries, settings):
            frame = bed_frame(values, settings, placement, _place(entry))
            motion.add(entry, frame.ids, frame.rows)
            stream.write(keeper.add(entry, frame).astype(np.float32).tobytes())
            bar.update()
        bar.close()
        with atomic_file(targets.trajectory) as temporary, temporary.open("wb") as final:
            keeper.write_final(stream, final, n_rows)
        stream.close()
        raw.write_bytes(b"")
    targets.trajectory.with_suffix(".part").unlink()
    write_particles(targets.particles, keeper.particles())
    write_text(targets.metadata, json.dumps(_metadata(frames, placement, keeper)))
    return motion


def _place(entry: Entry) -> str:
    return entry.file if entry.step is None else f"{entry.file}, step {entry.step}"


def _ahead(entries: list[Entry], settings: FrameSettings) -> Iterator[tuple[Entry, Columns]]:
    """Values of frames in order, the next ones read by two threads meanwhile."""
    waiting: deque[tuple[Entry, Future[Columns]]] = deque()
    with ThreadPoolExecutor(WORKERS) as pool:
        for entry, frame in raw_frames(entries, settings):
            waiting.append((entry, pool.submit(values_of, entry, frame)))
            if len(waiting) >= AHEAD:
                ready, future = waiting.popleft()
                yield ready, future.result()
        while waiting:
            ready, future = waiting.popleft()
            yield ready, future.result()


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
            "particles in the same order, say frames.without_ids: order"
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


class _Keeper:
    """Slots of particles over all frames: a particle keeps its slot, a new one gets the next."""

    def __init__(self, placement: Placement) -> None:
        self.placement = placement
        self.ids = np.empty(0, np.int64)  # in order of appearance
        self.sorted = self.slots = np.empty(0, np.int64)
        self.type: np.ndarray | None = None
        self.radius_m: np.ndarray | None = None
        self.sizes: list[int] = []
        self.lost = self.gained = 0
        self.present = 0

    def add(self, entry: Entry, frame: BedFrame) -> np.ndarray:
        """The frame's rows by slot, NaN for particles that are not in it."""
        place = _place(entry)
        self._check_bounds(frame, place)
        if not np.array_equal(frame.ids, self.sorted):
            self._meet(frame, place)
        slots = self.slots[np.searchsorted(self.sorted, frame.ids)]
        self._check_constant(frame, slots, place)
        self.sizes.append(self.ids.size)
        complete = frame.ids.size == self.ids.size
        if complete and bool((slots[1:] > slots[:-1]).all()):
            return frame.rows
        rows = np.full((len(frame.rows), self.ids.size), np.nan)
        rows[:, slots] = frame.rows
        return rows

    def _meet(self, frame: BedFrame, place: str) -> None:
        """Note new particles; refuse a change of particles where that is refused."""
        fresh = frame.ids[~np.isin(frame.ids, self.sorted, assume_unique=True)]
        gone = self.ids.size - (frame.ids.size - fresh.size)
        if self.sizes and self.placement.outside == "refuse":
            missing = np.setdiff1d(self.sorted, frame.ids)
            parts = [f"missing: id {listed(missing)}"] * bool(missing.size)
            parts += [f"new: id {listed(fresh)}"] * bool(fresh.size)
            raise UserError(
                f"{place}: other particles than in the first frame ({'; '.join(parts)}); where particles "
                "come and "
                "go, say outside: exit"
            )
        self.lost += gone if self.sizes else 0
        self.gained += fresh.size if self.sizes else 0
        if fresh.size:
            self.ids = np.concatenate((self.ids, fresh))
            self.slots = np.argsort(self.ids, kind="stable")
            self.sorted = self.ids[self.slots]
            self.type = _grown(self.type, frame.type, self.ids.size, -1)
            self.radius_m = _grown(self.radius_m, frame.radius_m, self.ids.size, np.nan)

    def _check_constant(self, frame: BedFrame, slots: np.ndarray, place: str) -> None:
        if self.type is not None and frame.type is not None:
            known = self.type[slots]
            changed = (known != frame.type) & (known >= 0)
            if changed.any():
                raise UserError(
                    f"{place}: the type of a particle has changed: id {listed(frame.ids[changed])}"
                )
            self.type[slots] = frame.type
        if self.radius_m is not None and frame.radius_m is not None:
            known = self.radius_m[slots]
            changed = np.abs(known - frame.radius_m) > SAME_RADIUS * known  # NaN of a new one is no change
            if changed.any():
                raise UserError(
                    f"{place}: the radius of a particle has changed, so its id means another one: "
                    f"id {listed(frame.ids[changed])}"
                )
            self.radius_m[slots] = frame.radius_m

    def _check_bounds(self, frame: BedFrame, place: str) -> None:
        if self.placement.outside != "refuse":
            return
        for row, name, size in ((0, "x", self.placement.width_m), (1, "z", self.placement.height_m)):
            position, top = frame.rows[row].astype(np.float32), np.float32(size)  # as it is stored
            if position.size and (position.min() < 0 or position.max() > top):
                outside = (position < 0) | (position > top)
                beyond = max(float(-position.min()), float(position.max() - size))
                raise UserError(
                    f"{place}: {outside.sum()} of {position.size} particles are outside the bed, 0 to "
                    f"{size:g} m "
                    f"along its {name} (id {listed(frame.ids[outside])}; by up to {beyond:.3g} m): check "
                    "frames.length_unit_m, frames.origin_m and the size of the bed, or say outside: exit"
                )

    @property
    def complete(self) -> bool:
        """Whether each particle is in every frame."""
        return not (self.lost or self.gained)

    def particles(self) -> Particles:
        """Properties, by id."""
        kind, radius = self.type, self.radius_m
        return Particles(
            self.sorted,
            None if kind is None else kind[self.slots].astype(np.int32),
            None if radius is None else radius[self.slots].astype(np.float32),
        )

    def write_final(self, stream: IO[bytes], final: IO[bytes], n_rows: int) -> None:
        """Frames of the file so far with all particles, by id."""
        write_npy_header(final, (len(self.sizes), n_rows, self.ids.size), np.dtype(np.float32))
        stream.seek(0)
        for size in self.sizes:
            rows = np.frombuffer(stream.read(4 * n_rows * size), np.float32).reshape(n_rows, size)
            if size < self.ids.size:
                rows = np.concatenate(
                    (rows, np.full((n_rows, self.ids.size - size), np.nan, np.float32)), axis=1
                )
            final.write(np.ascontiguousarray(rows[:, self.slots]).tobytes())


def _grown(known: np.ndarray | None, seen: np.ndarray | None, size: int, fill: float) -> np.ndarray | None:
    if known is None and seen is None:
        return None
    grown = np.full(size, fill, np.int64 if fill == -1 else np.float64)
    if known is not None:
        grown[: known.size] = known
    return grown


def _metadata(frames: Survey, placement: Placement, keeper: _Keeper) -> dict[str, Any]:
    depth = {"depth_m": _depth(frames, placement)} if placement.keep_depth else {}
    return {
        "times_s": [entry.time_s for entry in frames.entries],
        "steps": [entry.step for entry in frames.entries],
        "ids": [int(keeper.sorted[0]), int(keeper.sorted[-1])],
        "number": int(keeper.ids.size),
        "columns": [*STORED, *(["y"] if placement.keep_depth else [])],
        "units": ["m", "m", "m/s", "m/s", *(["m"] if placement.keep_depth else [])],
        "frame_interval_s": frames.interval_s,
        "width_m": placement.width_m,
        "height_m": placement.height_m,
        "complete": keeper.complete,
        "source": "frames",
        "files_start_s": frames.start_s,
        **depth,
    }


def _depth(frames: Survey, placement: Placement) -> float:
    low, high = frames.box_m[POSITION.index(placement.axes[1])]
    return float(f"{high - low:.9g}")
