# SPDX-License-Identifier: GPL-3.0-or-later
"""Places of particles in the store, over all frames: a particle keeps its place, a new one gets the next."""

from typing import IO

import numpy as np

from bedchain.errors import UserError
from bedchain.files import write_npy_header
from bedchain.trajectory.bed_frames import BedFrame, Placement, place_of
from bedchain.trajectory.dumps import listed
from bedchain.trajectory.frame_files import Entry
from bedchain.trajectory.particles import Particles

SAME_RADIUS = 1e-3


class ParticleSlots:
    """Slots of the particles of frames that are added in order of time.

    Parameters
    ----------
    placement : Placement
    """

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
        place = place_of(entry)
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
