# SPDX-License-Identifier: GPL-3.0-or-later
"""Somebody else's frames into the store: checked, moved to the bed's corner, a few in memory at a time."""

import json
import logging
from collections import deque
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from tqdm import tqdm

from bedchain.files import atomic_file, write_text
from bedchain.trajectory.bed_frames import Placement, bed_frame, place_of
from bedchain.trajectory.forms.raw import POSITION, Columns
from bedchain.trajectory.frame_files import Entry, FrameSettings, raw_frames, values_of
from bedchain.trajectory.motion import MotionCheck
from bedchain.trajectory.particle_slots import ParticleSlots
from bedchain.trajectory.particles import write_particles
from bedchain.trajectory.store import STORED, check_disk
from bedchain.trajectory.survey import Survey

LOG = logging.getLogger(__name__)

WORKERS = 2
AHEAD = 3  # frames in memory


class Targets(NamedTuple):
    """Files to make: ``trajectory.npy``, ``trajectory.json``, ``particles.npz``."""

    trajectory: Path
    metadata: Path
    particles: Path


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
    keeper = ParticleSlots(placement)
    motion = MotionCheck(placement.periods_m[::2])
    with ExitStack() as stack:
        raw = stack.enter_context(atomic_file(targets.trajectory.with_suffix(".part")))
        stream = stack.enter_context(raw.open("w+b"))
        bar = tqdm(total=len(entries), desc="import_frames", unit="frame", disable=not progress)
        for entry, values in _ahead(entries, settings):
            frame = bed_frame(values, settings, placement, place_of(entry))
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


def _metadata(frames: Survey, placement: Placement, keeper: ParticleSlots) -> dict[str, Any]:
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
