# SPDX-License-Identifier: GPL-3.0-or-later
"""The frames behind a pattern of files: their order, times, box and particles, by a look at each of them."""

import json
import logging
import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bedchain.errors import DataError, UserError
from bedchain.files import write_text
from bedchain.trajectory.forms.files import frames_of
from bedchain.trajectory.forms.raw import POSITION, Columns, CutOffError
from bedchain.trajectory.frame_files import Entry, FrameSettings, files_of, load, loaded, radii

LOG = logging.getLogger(__name__)

# of an interval: times of tables have few digits
UNEVEN = 1e-3
BOX_DIGITS = 3  # of a box that is made of the particles' positions
SHORTEST = 1e-300  # of a span; its digits would be no numbers
STEPS = " by frames.first_step and frames.last_step"
DIGITS = 12  # of a time, so that 12000 steps of 1e-5 s are 0.12 s


class Survey(NamedTuple):
    """What the frames of a pattern are.

    Attributes
    ----------
    entries : list of Entry
        In order of time.
    start_s : float
        Time of the first frame by the files [s].
    columns : list of str
        Of the first frame, by our names.
    box_m : list of list of float
        Lower and upper bound in x, y and z of the files [m].
    from_header : bool
        Whether the box was written in the files; otherwise it is that of the particles.
    diameters_m : list of float or None
        Mean, smallest and largest diameter of the first frame [m].
    periodic : list of bool
        Of the box in x, y and z.
    number : int
        Particles in the first frame.
    notes : list of str
        What was passed over, joined or left out.
    """

    entries: list[Entry]
    start_s: float
    columns: list[str]
    box_m: list[list[float]]
    from_header: bool
    diameters_m: list[float] | None
    periodic: list[bool]
    number: int
    notes: list[str]

    def periods_m(self, axes: Sequence[str]) -> list[float]:
        """Lengths of the box along axes of the files, 0 where it is not periodic [m]."""
        places = [POSITION.index(axis[-1]) for axis in axes]
        return [(self.box_m[at][1] - self.box_m[at][0]) * self.periodic[at] for at in places]

    @property
    def interval_s(self) -> float:
        """Time between frames [s]."""
        gaps = np.diff([entry.time_s for entry in self.entries])
        return float(f"{np.median(gaps):.{DIGITS}g}")


def survey(settings: FrameSettings, folder: Path, whole_box: bool = True) -> Survey:
    """Look at every frame of a pattern.

    Parameters
    ----------
    settings : FrameSettings
    folder : Path
        That the pattern is relative to.
    whole_box : bool
        Whether particles are read for their bounds where no header has a box.

    Returns
    -------
    Survey

    Raises
    ------
    UserError
        There are no files or frames, or a file cannot be read.
    """
    files, notes = files_of(settings.files, folder), []
    entries, first, box = [], None, None
    passed, doubled, empty = 0, 0, 0
    clocks: list[tuple[int | None, float | None]] = []
    for file in files:
        at = -1
        try:
            for at, frame in enumerate(frames_of(file, settings.reading, keep=False)):  # noqa: B007
                if frame.number == 0:
                    empty += 1
                    continue
                if not _wanted(frame.step, settings):
                    continue
                clocks.append((frame.step, frame.time))
                entries.append(Entry(str(file), at, frame.step, 0.0, frame.number))
                box = _union(box, frame.box)
                first = first or frame
        except CutOffError as error:
            notes.append(f"left out: {error}")
        else:
            passed += at < 0
    entries, start_s, doubled = _in_order(entries, clocks, settings)
    if not entries:
        raise UserError(
            f"{settings.files}: {len(files)} files, and no frame with particles in them" + _listed(notes)
        )
    entries, notes = _without_broken_end(entries, settings, notes)
    for number, text in (
        (passed, "files that hold no particles were passed over"),
        (empty, "empty frames were skipped"),
        (doubled, "frames were there twice, of which the later ones were taken"),
    ):
        if number:
            notes.append(f"{number} {text}")
    assert first is not None
    values = load(entries[0], settings)
    if not values:
        raise UserError(f"{entries[0].file}: no column of use; name them in frames.columns")
    periodic = list(first.periodic)
    from_header = box is not None
    if box is None:
        box = _bounds(entries if whole_box else entries[:1], settings)
    scale = settings.length_unit_m
    return Survey(
        entries, start_s, list(values), (np.asarray(box) * scale).tolist(), from_header,
        _diameters(values, scale), periodic, len(next(iter(values.values()))), notes,
    )  # fmt: skip


def _listed(notes: Sequence[str]) -> str:
    return "".join(f"; {note}" for note in notes)


def _wanted(step: int | None, settings: FrameSettings) -> bool:
    if step is None:
        return True
    low, high = settings.first_step, settings.last_step
    return (low is None or step >= low) and (high is None or step <= high)


def _union(box: np.ndarray | None, other: np.ndarray | None) -> np.ndarray | None:
    if box is None or other is None:
        return other if box is None else box
    return np.column_stack((np.minimum(box[:, 0], other[:, 0]), np.maximum(box[:, 1], other[:, 1])))


def _in_order(
    entries: list[Entry], clocks: list[tuple[int | None, float | None]], settings: FrameSettings
) -> tuple[list[Entry], float, int]:
    """Entries in order of time, counted from the first one; of frames that are there twice the later one."""
    if not entries:
        return [], 0.0, 0
    times = [_time_s(entry, clock, settings) for entry, clock in zip(entries, clocks, strict=True)]
    latest = {f"{time:.{DIGITS}g}": at for at, time in enumerate(times)}
    order = sorted(latest.values(), key=lambda at: times[at])
    start_s = times[order[0]]
    ordered = [entries[at]._replace(time_s=float(f"{times[at] - start_s:.{DIGITS}g}")) for at in order]
    return ordered, start_s, len(entries) - len(ordered)


def _time_s(entry: Entry, clock: tuple[int | None, float | None], settings: FrameSettings) -> float:
    step, time = clock
    if settings.step_s is not None and step is not None:
        return step * settings.step_s
    if time is not None:
        return time * settings.time_unit_s
    if step is None:
        raise UserError(
            f"{entry.file}: neither a time nor a step in the file, and no number in its name: number the "
            "files"
        )
    raise UserError(
        f"{entry.file}: step {step}, and no time: give frames.step_s, the time of a step in seconds"
    )


def _without_broken_end(
    entries: list[Entry], settings: FrameSettings, notes: list[str]
) -> tuple[list[Entry], list[str]]:
    """The entries less the last one where it cannot be read: a killed job leaves such a file."""
    if len(entries) < 2:
        return entries, notes
    try:
        load(entries[-1], settings)
    except DataError as error:
        return entries[:-1], [*notes, f"left out, the last frame: {error}"]
    return entries, notes


def _bounds(entries: Sequence[Entry], settings: FrameSettings) -> np.ndarray:
    """Lower and upper bound of the particles with their radii, in the unit of the files."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for _, values in loaded(entries, settings):
        for axis, name in enumerate(POSITION):
            if name in values and len(values[name]):
                reach = radii(values)
                low[axis] = min(low[axis], np.nanmin(values[name] - reach))
                high[axis] = max(high[axis], np.nanmax(values[name] + reach))
    absent = ~np.isfinite(low)
    low[absent] = high[absent] = 0.0
    return np.array([rounded_outwards(*ends) for ends in zip(low, high, strict=True)])


def rounded_outwards(low: float, high: float) -> tuple[float, float]:
    """Ends of a span, the span a little longer so that it is a number of few digits."""
    if not high - low > SHORTEST:
        return low, high
    if not math.isfinite(high - low):
        raise UserError(f"particles from {low:g} to {high:g}: some positions are no lengths")
    grain = 10.0 ** (math.floor(math.log10(high - low)) - BOX_DIGITS)
    first, last = math.floor(low / grain), math.ceil(high / grain)
    return float(f"{first * grain:.{DIGITS}g}"), float(f"{last * grain:.{DIGITS}g}")


def _diameters(values: Columns, scale: float) -> list[float] | None:
    if not {"radius", "diameter"} & values.keys():
        return None
    diameters = 2 * scale * radii(values)
    mean, low, high = float(diameters.mean()), float(diameters.min()), float(diameters.max())
    return [float(f"{value:.6g}") for value in (mean, low, high)]


def check_even(frames: Survey) -> None:
    """Refuse frames that are not one interval apart.

    Raises
    ------
    UserError
        The first uneven pair is named, with the factor.
    """
    entries, times = frames.entries, np.array([entry.time_s for entry in frames.entries])
    if len(times) < 2:
        raise UserError(f"{entries[0].file}: a single frame; a chain is learned from many")
    gaps, interval = np.diff(times), frames.interval_s
    for at in np.flatnonzero(np.abs(gaps - interval) > UNEVEN * interval)[:1]:
        before, after = (_place(entries[at + shift]) for shift in (0, 1))
        raise UserError(
            f"frames are not evenly spaced: {after} is {gaps[at] / interval:.4g} intervals of {interval:g} "
            "s after "
            f"{before}; take a stretch of even frames" + (STEPS if entries[at].step is not None else "")
        )


def _place(entry: Entry) -> str:
    clock = f"{entry.time_s:g} s" if entry.step is None else f"step {entry.step}"
    return f"{Path(entry.file).name} ({clock})"


def cached_survey(settings: FrameSettings, folder: Path, cache: Path, whole_box: bool = True) -> Survey:
    """`survey`, or the same from a file where neither the settings nor the user's files have changed.

    Parameters
    ----------
    settings, folder, whole_box
        As of `survey`.
    cache : Path
        JSON file.
    """
    files = [
        (str(file), file.stat().st_size, file.stat().st_mtime_ns) for file in files_of(settings.files, folder)
    ]
    stamp = json.loads(json.dumps([asdict(settings), files, whole_box]))
    try:
        kept = json.loads(cache.read_text(encoding="utf-8"))
        if kept["stamp"] == stamp:
            entries = [Entry(*entry) for entry in kept["survey"].pop("entries")]
            return Survey(entries, **kept["survey"])
    except (OSError, ValueError, KeyError, TypeError):
        pass
    result = survey(settings, folder, whole_box)
    write_text(cache, json.dumps({"stamp": stamp, "survey": result._asdict()}))
    return result
