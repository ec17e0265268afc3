# SPDX-License-Identifier: GPL-3.0-or-later
"""Somebody else's frames as the trajectory of a case, and what their motion says of them."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from bedchain.files import write_csv
from bedchain.stage import LOG, run_stage
from bedchain.trajectory.bed_frames import Placement
from bedchain.trajectory.chunks import CHUNK_BYTES, read_frames
from bedchain.trajectory.frames_of_case import placement_of, settings_of
from bedchain.trajectory.imported import Targets, write_imported
from bedchain.trajectory.store import open_trajectory
from bedchain.trajectory.survey import Survey, cached_survey, check_even
from bedchain.trajectory.track import resample

PERIODIC = (
    "the box is periodic along %s, each %g m: who leaves at one side comes in at the other, which cells see "
    "as a move; distances between frames, such as in choice.csv and the dispersion, do not know of it"
)
CUT_PERIOD = (
    "the box is periodic along %s, each %g m, and the bed is not as long: who crosses its side jumps; give "
    "the bed the size of the box"
)


class Box(NamedTuple):
    """The bed: its size [m], and whether particles may leave it."""

    width_m: float
    height_m: float
    outside: str


@dataclass(frozen=True)
class Tables:
    """Tables to make.

    Attributes
    ----------
    bed_series : Path
        Mean height of the particles over time.
    motion : Path
        Displacements beside velocities, interval by interval.
    """

    bed_series: Path
    motion: Path


def import_frames(
    section: dict[str, Any], folder: Path, box: Box, targets: Targets, tables: Tables, progress: bool = True
) -> None:  # fmt: skip
    """Store the frames and check them as physics.

    Parameters
    ----------
    section : dict
        Section ``frames`` of the case, complete.
    folder : Path
        Of the case.
    box : Box
    targets : Targets
    tables : Tables
    progress : bool
        Show a progress bar on stderr.

    Raises
    ------
    UserError
        Frames are missing, uneven, or cannot be used; no trajectory is written.
    """
    settings = settings_of(section)
    frames = cached_survey(settings, folder, targets.metadata.with_name("frames.json"), whole_box=False)
    if "every_s" not in section:
        check_even(frames)
    placement = in_periods(placement_of(section, *box), frames)
    motion = write_imported(frames, settings, placement, targets, progress)
    if "every_s" in section:
        every_s = section["every_s"]
        LOG.info(resample(targets.trajectory, targets.metadata, every_s, section.get("reach_s", every_s)))
    store, about = open_trajectory(targets.trajectory, targets.metadata)
    write_csv(bed_series(store, np.array(about["times_s"])), tables.bed_series)
    write_csv(motion.table(), tables.motion)
    for note in frames.notes:
        LOG.info("note: %s", note)
    for warning in motion.warnings():
        LOG.warning("warning: %s", warning)
    LOG.info(
        "%d frames of %d particles, first at %g s of the files, which is t = 0 here",
        *store.shape[::2],
        frames.start_s,
    )


def in_periods(placement: Placement, frames: Survey) -> Placement:
    """The placement with the lengths after which the frames repeat, and a warning of what that means."""
    lengths = frames.periods_m(placement.axes)
    sizes = (placement.width_m, lengths[1], placement.height_m)
    periods = [
        length if np.isclose(length, size) else 0.0 for length, size in zip(lengths, sizes, strict=True)
    ]
    for name, length, period in zip(placement.axes, lengths, periods, strict=True):
        if length:
            LOG.warning("warning: " + (PERIODIC if period else CUT_PERIOD), name, length)
    return replace(placement, periods_m=(periods[0], periods[1], periods[2]))


def bed_series(store: np.ndarray, times_s: np.ndarray) -> pd.DataFrame:
    """Mean height and number of the particles in each frame: time_s, mean_height_m, particles_1."""
    heights, numbers = [], []
    step = max(CHUNK_BYTES // 4 // max(store[:1].nbytes, 1), 1)
    for first in range(0, len(store), step):
        z = read_frames(store, first, min(first + step, len(store)))[:, 1].astype(float)
        number = np.isfinite(z).sum(axis=1)
        with np.errstate(invalid="ignore"):  # no height where no tracer was located
            heights += (np.nansum(z, axis=1) / number).tolist()
        numbers += number.tolist()
    return pd.DataFrame({"time_s": times_s, "mean_height_m": heights, "particles_1": numbers})


if rule := globals().get("snakemake"):
    run_stage(import_frames, rule)
