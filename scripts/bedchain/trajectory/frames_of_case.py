# SPDX-License-Identifier: GPL-3.0-or-later
"""The frames of a case: its section as settings, and the numbers of a case that the frames tell."""

import math
from pathlib import Path
from typing import Any

import numpy as np

from bedchain.errors import UserError
from bedchain.trajectory.bed_frames import Placement
from bedchain.trajectory.forms.files import FormSettings
from bedchain.trajectory.forms.raw import POSITION
from bedchain.trajectory.frame_files import FrameSettings, load
from bedchain.trajectory.survey import Survey, cached_survey, check_even

Case = dict[str, Any]
MOMENTS = (1, 2, 4, 8, 16, 32)  # of the figures, in lags
CELL_SHARES = (40, 20, 10, 5, 3)  # of the discussion, cells in the width
GAS_CELL_DIAMETERS = 5  # in which the film shows the voidage
DEEP_DIAMETERS = 1.5  # from there on the third axis is stored
DIGITS = 9
WHOLE = 0.01  # of an interval


def settings_of(section: Case) -> FrameSettings:
    """Settings of the reader from the section ``frames`` of a case, with its defaults."""
    names = section.get("names")
    reading = FormSettings(section.get("form"), tuple(names) if names else None, section.get("columns", {}))
    keys = ("files", "step_s", "length_unit_m", "time_unit_s", "first_step", "last_step")
    return FrameSettings(**{key: section[key] for key in keys if key in section}, reading=reading)


def placement_of(section: Case, width_m: float, height_m: float, outside: str) -> Placement:
    """Placement of the bed from the section ``frames`` of a case, with its defaults and its origin."""
    keys = ("across", "up", "keep_depth", "without_ids")
    left, front, bottom = section["origin_m"]
    return Placement(
        **{key: section[key] for key in keys}, origin_m=(left, front, bottom), width_m=width_m,
        height_m=height_m, outside=outside,
    )  # fmt: skip


def measured_sections(case: Case, folder: Path, cache: Path) -> Case:
    """Keys of a case by section that its frames tell, to be taken where the case does not give them.

    Parameters
    ----------
    case : dict
        As written, the section ``frames`` with its defaults.
    folder : Path
        Of the case, which the pattern is relative to.
    cache : Path
        Keeps the look at the frames until they change.

    Raises
    ------
    UserError
        There are no frames, they are not evenly spaced, or have no radius and the case no diameter.
    """
    section, bed = case["frames"], case.get("bed", {})
    settings = settings_of(section)
    placed = {"width_m", "height_m"} <= bed.keys() and "origin_m" in section
    frames = cached_survey(settings, folder, cache, whole_box=not placed)
    if "every_s" not in section:
        check_even(frames)
    origin, sizes = corner_and_sizes(frames, section)
    diameter = case.get("particles", {}).get("diameter_m") or mean_diameter(frames)
    if not isinstance(diameter, int | float):
        raise UserError("the frames have no radius: give particles.diameter_m, the particles' diameter")
    interval, width = section.get("every_s", frames.interval_s), bed.get("width_m", sizes[0])
    lag = case.get("chain", {}).get("lag_s", interval)
    window = case.get("comparison", {})
    lasts = window.get("end_s", math.inf) - window.get("start_s", 0)
    moments = [float(f"{lag * count:.{DIGITS}g}") for count in MOMENTS if lag * count <= lasts * (1 + 1e-9)]
    middle = median_height(frames, settings, section, section.get("origin_m", origin)[2])
    cell_sizes = [float(f"{width / count:.4g}") for count in CELL_SHARES if width / count >= diameter]
    thickness = {"thickness_m": sizes[1]} if sizes[1] >= diameter else {}
    return {
        "frames": {"origin_m": list(origin), "keep_depth": sizes[1] > DEEP_DIAMETERS * diameter},
        "bed": {"width_m": sizes[0], "height_m": sizes[2], **thickness},
        "particles": {"number": frames.number, "diameter_m": diameter},
        "time": {"end_s": whole(frames.entries[-1].time_s, interval), "frame_interval_s": interval},
        "gas": {"model": "none", "cell_size_m": GAS_CELL_DIAMETERS * diameter},
        "chain": {"lag_s": interval},
        "mixing": {"split_z_m": middle},
        "discussion": {"cell_sizes_m": cell_sizes or [diameter]},
        "figures": {"batch_height_m": float(f"{middle / 2:.3g}"), "moments_s": moments or [lag]},
    }


def whole(time_s: float, interval_s: float) -> float:
    """Last multiple of an interval up to a time, which is the time itself up to its round-off [s]."""
    count = time_s / interval_s
    return time_s if abs(count - round(count)) < WHOLE else float(f"{int(count) * interval_s:.{DIGITS}g}")


def mean_diameter(frames: Survey) -> float | None:
    """Mean diameter of the particles in the first frame [m]; None where the frames have none."""
    return frames.diameters_m[0] if frames.diameters_m else None


def corner_and_sizes(frames: Survey, section: Case) -> tuple[list[float], list[float]]:
    """Left, front, bottom corner of the frames' box in the bed's axes, and its width, depth and height "
    "[m]."""
    corner, sizes = [], []
    for axis in Placement(section["across"], section["up"], (0, 0, 0), 1, 1).axes:
        low, high = frames.box_m[POSITION.index(axis[-1])]
        corner.append(float(f"{-high if axis.startswith('-') else low:.{DIGITS}g}"))
        sizes.append(float(f"{high - low:.{DIGITS}g}"))
    return corner, sizes


def median_height(frames: Survey, settings: FrameSettings, section: Case, bottom_m: float) -> float:
    """Median height of the particles in the first frame above the bottom of the bed [m]."""
    up = section["up"]
    values = load(frames.entries[0], settings).get(up[-1])
    if values is None:
        raise UserError(f"{frames.entries[0].file}: there is no position {up[-1]} (frames.up)")
    height = float(np.median(values)) * settings.length_unit_m * (-1 if up.startswith("-") else 1) - bottom_m
    return max(float(f"{height:.3g}"), 1e-6)
