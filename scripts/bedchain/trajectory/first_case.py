# SPDX-License-Identifier: GPL-3.0-or-later
"""A first case file for a pattern of frames: box, windows, cells and step, with the reason beside each."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from bedchain.errors import UserError
from bedchain.trajectory.bed_frames import Placement, bed_frame
from bedchain.trajectory.frame_files import FrameSettings, loaded
from bedchain.trajectory.frames_of_case import corner_and_sizes, mean_diameter
from bedchain.trajectory.motion import MotionCheck, seams
from bedchain.trajectory.survey import UNEVEN, Survey, check_even, survey

CELL_DIAMETERS = 5
MOST_CELLS = 20  # along a side, for a start
FEWEST_FRAMES = 9  # four to learn from, four to compare over, and the start
LEARNED = (0.1, 0.55)  # of the time of the frames
LARGEST_M = 10.0  # a bed beyond it is in millimetres
GUESSED_DIAMETER = 0.01  # of the width, where the frames have no radius
ROUND = 0.1  # an estimated step within it of 1, 2 or 5 times a power of ten is that
FEWEST_IN_CELL = 20  # positions of all frames, so that a cell is left some times
Line = tuple[str, str]


class Clock(NamedTuple):
    """Number of frames that the chain sees, and the time between them [s]."""

    frames: int
    interval_s: float


class FirstCase(NamedTuple):
    """A case file, and what its writer has to say."""

    text: str
    notes: list[str]


def first_case(settings: FrameSettings, folder: Path, title: str) -> FirstCase:
    """Text of a case for a pattern of frames, ready to run.

    Parameters
    ----------
    settings : FrameSettings
        As far as they are known: pattern, and perhaps the step and units.
    folder : Path
        That the pattern is relative to.
    title : str

    Raises
    ------
    UserError
        The frames cannot be read or are too few; or their step is not known and cannot be estimated.
    """
    clocked = settings.step_s is not None
    look = survey(settings if clocked else replace(settings, step_s=1.0), folder)
    if len(look.entries) < FEWEST_FRAMES:
        raise UserError(
            f"{settings.files}: {len(look.entries)} frames of {look.number} particles; at least "
            f"{FEWEST_FRAMES} are needed to learn a chain from some and compare it with others"
        )
    lines: list[Line] = []
    scaled = _in_metres(look, settings)
    if scaled.length_unit_m != settings.length_unit_m:
        lines.append(
            (f"length_unit_m: {scaled.length_unit_m:g}", "the box would be larger than 10 m; correct it")
        )
        look = survey(scaled if clocked else replace(scaled, step_s=1.0), folder)
    if is_track(look):
        scaled, more = _of_track(scaled, settings)
        frames = survey(scaled, folder)
        every_s = round_up(frames.interval_s)
        more.append((f"every_s: {every_s:g}", "a round number of at least the usual time between locations"))
        clock = Clock(int(frames.entries[-1].time_s / every_s) + 1, every_s)
        return FirstCase(_text(title, scaled, frames, [*lines, *more], clock), frames.notes)
    stepped = any(entry.step is not None for entry in look.entries)
    motion = _motion(look, replace(scaled, step_s=scaled.step_s or 1.0))
    if not clocked and stepped:
        step_s = _step(motion, look)
        reason = "estimated: displacements over velocities; correct it"
        scaled = replace(scaled, step_s=step_s)
        lines.insert(0, (f"step_s: {_decimal(step_s)}", reason))
    elif clocked:
        lines.insert(0, (f"step_s: {_decimal(scaled.step_s)}", "as given"))
    first, last, reason = _longest_stretch(motion, look)
    if reason:
        scaled = replace(scaled, first_step=first, last_step=last)
        lines += [
            (f"{key}_step: {step}", reason)
            for key, step in (("first", first), ("last", last))
            if step is not None
        ]
    frames = survey(scaled, folder)
    check_even(frames)
    clock = Clock(len(frames.entries), frames.interval_s)
    return FirstCase(_text(title, scaled, frames, [*lines, *_identity(frames)], clock), frames.notes)


def is_track(look: Survey) -> bool:
    """Whether frames are the locations of a single tracer at uneven times, such as those of PEPT."""
    gaps = np.diff([entry.time_s for entry in look.entries])
    uneven = bool((np.abs(gaps - look.interval_s) > UNEVEN * look.interval_s).any())
    return (
        uneven and "id" not in look.columns and np.median([entry.number or 0 for entry in look.entries]) == 1
    )


def _of_track(scaled: FrameSettings, given: FrameSettings) -> tuple[FrameSettings, list[Line]]:
    """Settings of a track, and what to say of them."""
    lines = [("without_ids: one_tracer", "no ids: all rows are taken for locations of one tracer")]
    if scaled.length_unit_m != given.length_unit_m and given.time_unit_s == 1:
        scaled = replace(scaled, time_unit_s=1e-3)
        lines.append(("time_unit_s: 0.001", "tracks in millimetres have their times in ms; correct it"))
    return scaled, lines


def round_up(value: float) -> float:
    """The next 1, 2 or 5 times a power of ten."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(f"{next(power * factor for factor in (1, 2, 5, 10) if power * factor >= value):.3g}")


def _decimal(value: float | None) -> str:
    """A number that every reader of YAML takes for one: 1.0e-05, not 1e-05."""
    mantissa, mark, power = f"{value:g}".partition("e")
    return mantissa + ("" if "." in mantissa or not mark else ".0") + mark + power


def _in_metres(look: Survey, settings: FrameSettings) -> FrameSettings:
    largest = max(high - low for low, high in look.box_m)
    return (
        replace(settings, length_unit_m=1e-3)
        if largest > LARGEST_M and settings.length_unit_m == 1
        else settings
    )


def _motion(look: Survey, settings: FrameSettings) -> MotionCheck | None:
    """Displacements beside velocities; None where there are none to compare."""
    if "vx" not in look.columns or len(look.entries) < 2 or not {"x", "z"} <= set(look.columns):
        return None
    place = Placement("x", "z", (0, 0, 0), 1, 1, outside="exit", without_ids="order")
    check = MotionCheck()
    for entry, values in loaded(look.entries, settings):
        frame = bed_frame(values, settings, place, entry.file)
        check.add(entry, frame.ids, frame.rows)
    return check


def _step(motion: MotionCheck | None, look: Survey) -> float:
    slope = motion.slope() if motion is not None else None
    if slope is None:
        raise UserError(
            f"{look.entries[0].file}: the frames carry steps and no times, and no velocities to estimate "
            "them by: "
            "give --step_s, the time of a step in seconds"
        )
    power = 10.0 ** np.floor(np.log10(slope))
    near = min((power * factor for factor in (1, 2, 5, 10)), key=lambda value: abs(np.log(value / slope)))
    return float(f"{near if abs(near / slope - 1) < ROUND else slope:.3g}")


def _longest_stretch(motion: MotionCheck | None, look: Survey) -> tuple[int | None, int | None, str]:
    """First and last step between two seams, and the reason; None where the end is that of the frames."""
    cuts = [] if motion is None else seams(motion)
    if not cuts or look.entries[0].step is None:
        return None, None, ""
    edges = [0, *cuts, len(look.entries)]
    begin, end = max(zip(edges[:-1], edges[1:], strict=True), key=lambda pair: pair[1] - pair[0])
    first = None if begin == 0 else look.entries[begin].step
    last = None if end == len(look.entries) else look.entries[end - 1].step
    return first, last, "other frames do not follow from these by their velocities: another run"


def _identity(frames: Survey) -> list[Line]:
    if "id" in frames.columns or frames.number == 1:
        return []
    return [("without_ids: order", "no ids: right only where all frames list the particles in one order")]


def _text(title: str, settings: FrameSettings, frames: Survey, lines: Sequence[Line], clock: Clock) -> str:
    section: dict[str, Any] = {"across": "x", "up": "z"}
    corner, (width, _, height) = corner_and_sizes(frames, section)
    if min(width, height) <= 0:
        raise UserError(
            f"{settings.files}: all particles are in one line, along x or z; no bed has that shape"
        )
    diameter = mean_diameter(frames)
    cell = CELL_DIAMETERS * (diameter or GUESSED_DIAMETER * width)
    most = int(max(1, min(MOST_CELLS, (frames.number * clock.frames / FEWEST_IN_CELL) ** 0.5)))
    columns, rows = (_cells(length, cell, most) for length in (width, height))
    windows = _windows(*clock)
    box = "as the files say" if frames.from_header else "what the particles stay in"
    split = _split(frames, settings, corner[2], rows, height / rows)
    names = settings.reading.names
    given = [(f"names: [{', '.join(names)}]", "as given")] if names else []
    rows_of_text: list[tuple[str, str]] = [
        (f"title: {title}", ""),
        ("", ""),
        (
            "frames:",
            f"{len(frames.entries)} frames of {frames.number} particles, "
            f"{'mostly ' if clock.interval_s != frames.interval_s else ''}{frames.interval_s:g} s apart",
        ),
        (f'  files: "{settings.files}"', ""),
        *((f"  {line}", reason) for line, reason in [*lines, *given]),
        ("  up: z", "the axis against gravity"),
        ("  across: x", ""),
        (f"  origin_m: [{', '.join(f'{value:.9g}' for value in corner)}]", box),
        ("", ""),
        (f"bed: {{width_m: {width:.9g}, height_m: {height:.9g}}}", f"{box}; in the bed they start at 0"),
        (
            f"particles: {{diameter_m: {diameter or cell / CELL_DIAMETERS:.4g}}}",
            "mean of the first frame" if diameter else "a guess, the frames have no radius: correct it",
        ),
    ]
    if len({entry.number for entry in frames.entries}) > 1 and not is_track(frames):
        rows_of_text.append(("outside: exit", "the number of particles changes"))
    rows_of_text += [
        ("", ""),
        (
            f"cells: {{columns: {columns}, rows: {rows}}}",
            f"at least {CELL_DIAMETERS} diameters wide, for a start",
        ),
        (f"learning: {{start_s: {windows[0]:.9g}, end_s: {windows[1]:.9g}}}", "t = 0 is the first frame"),
        (f"comparison: {{start_s: {windows[1]:.9g}, end_s: {windows[2]:.9g}}}", "the rest"),
        (f"mixing: {{split_z_m: {split:.6g}}}", "border of two rows nearest to the median height"),
    ]
    return (
        "\n".join(f"{line}  # {reason}".rstrip() if reason else line for line, reason in rows_of_text) + "\n"
    )


def _cells(length: float, cell: float, most: int) -> int:
    number = max(1, min(most, int(length / cell)))
    return number - number % 2 if number > 1 else number


def _windows(n_frames: int, interval_s: float) -> tuple[float, float, float]:
    last = n_frames - 1
    start, middle = (round(share * last) for share in LEARNED)
    return tuple(float(f"{at * interval_s:.12g}") for at in (start, middle, last))  # type: ignore[return-value]


def _split(frames: Survey, settings: FrameSettings, bottom_m: float, rows: int, row_m: float) -> float:
    """Border of two rows nearest to the median height, of the first frame or of a whole track [m]."""
    entries = frames.entries if is_track(frames) else frames.entries[:1]
    heights = np.concatenate([values["z"] for _, values in loaded(entries, settings)])
    height = float(np.median(heights)) * settings.length_unit_m - bottom_m
    return min(max(1, rows - 1), max(1, round(height / row_m))) * row_m
