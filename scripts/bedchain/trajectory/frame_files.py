# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames behind a pattern of files: how to read them, where each is, and its values."""

import glob
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from bedchain.errors import DataError, UserError
from bedchain.trajectory.forms.files import FormSettings, frames_of
from bedchain.trajectory.forms.raw import Columns, RawFrame


@dataclass(frozen=True)
class FrameSettings:
    """The section ``frames`` of a case.

    Parameters
    ----------
    files : str
        Pattern of files.
    step_s : float, optional
        Time of a step [s]; without it times come from the files.
    length_unit_m, time_unit_s : float
        Unit of lengths and of times in the files [m, s].
    first_step, last_step : int, optional
        Frames outside are passed over.
    reading : FormSettings
    """

    files: str
    step_s: float | None = None
    length_unit_m: float = 1.0
    time_unit_s: float = 1.0
    first_step: int | None = None
    last_step: int | None = None
    reading: FormSettings = field(default_factory=FormSettings)


class Entry(NamedTuple):
    """Where a frame is.

    Attributes
    ----------
    file : str
    at : int
        Number of the frame in the file.
    step : int or None
    time_s : float
        After the first frame [s].
    number : int or None
        Particles that its header announces.
    """

    file: str
    at: int
    step: int | None
    time_s: float
    number: int | None


def files_of(pattern: str, folder: Path) -> list[Path]:
    """Files of a pattern, by the numbers in their names.

    Parameters
    ----------
    pattern : str
        Relative to a folder, or absolute; ``**`` for folders below.
    folder : Path

    Raises
    ------
    UserError
        There are none.
    """
    full = str(folder / pattern)
    names = glob.glob(full, recursive=True)
    if not names and Path(full).exists():
        names = [full]
    files = sorted((Path(name) for name in names if not Path(name).is_dir()), key=_natural)
    if not files:
        place = next(parent for parent in Path(full).parents if parent.exists() and "*" not in str(parent))
        raise UserError(
            f"no file is named {full}; the folder {place} exists: give the pattern in quotes, with *"
        )
    return files


def _natural(path: Path) -> list[tuple[int, int | str]]:
    parts = re.split(r"(\d+)", str(path))
    return [(0, int(part)) if part.isdigit() else (1, part) for part in parts]


def load(entry: Entry, settings: FrameSettings) -> Columns:
    """Values of a single frame; see `loaded`."""
    return next(values for _, values in loaded([entry], settings))


def loaded(entries: Sequence[Entry], settings: FrameSettings) -> Iterator[tuple[Entry, Columns]]:
    """Values of frames, each file read once where they follow one another in it.

    Raises
    ------
    DataError
        A frame cannot be read; file and step are named.
    """
    for entry, frame in raw_frames(entries, settings):
        yield entry, values_of(entry, frame)


def values_of(entry: Entry, frame: RawFrame) -> Columns:
    """Values of a frame, whose faults name file and step."""
    try:
        return frame.load()
    except DataError as error:
        place = entry.file if entry.step is None else f"{entry.file}, step {entry.step}"
        raise DataError(f"{place}: {error}") from error


def raw_frames(entries: Sequence[Entry], settings: FrameSettings) -> Iterator[tuple[Entry, RawFrame]]:
    """Frames of entries, read when they are loaded."""
    frames: Iterator[RawFrame] = iter(())
    file, at = "", -1
    for entry in entries:
        if entry.file != file or entry.at <= at:
            file, at = entry.file, -1
            frames = frames_of(Path(file), settings.reading)
        frame: RawFrame | None = None
        while at < entry.at:
            frame, at = next(frames), at + 1
        assert frame is not None
        yield entry, frame


def radii(values: Columns) -> Any:
    """Radii of a frame, 0 where it has none, in the unit of the files."""
    return values["radius"] if "radius" in values else values["diameter"] / 2 if "diameter" in values else 0.0
