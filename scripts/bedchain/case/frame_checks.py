# SPDX-License-Identifier: GPL-3.0-or-later
"""A case of frames: the sections that it must not have, those that the frames fill, and its checks."""

from collections.abc import Iterator
from typing import Any

from bedchain.case.check_registry import Finding, reads
from bedchain.errors import Problem
from bedchain.physics.whole_numbers import is_multiple, nearest_multiple, ratio

FRAMES = "frames"
OF_A_SIMULATION = ("seed", "drum", "contact", "gas", "time", "run")
# of the sections that the schema fills: what a case of frames uses
USED = {"time": ("end_s", "frame_interval_s"), "gas": ("model",)}
LARGEST_BED_M = 10.0


def simulation_problems(data: dict[str, Any], lines: dict[str, int]) -> list[Problem]:
    """Sections of a simulation in a case that has frames: a bed has one source."""
    return [
        Problem(
            name,
            "belongs to a simulation, and this case has frames",
            "leave one of the two out",
            lines.get(name),
        )
        for name in OF_A_SIMULATION
        if name in data
    ]


def with_measured(case: dict[str, Any], measured: dict[str, Any]) -> dict[str, Any]:
    """A case with the keys that its frames tell of, where it does not give them itself."""
    filled = dict(case)
    for section, keys in measured.items():
        given = case.get(section, {})
        filled[section] = keys | given if isinstance(given, dict) else given
    return filled


def without_simulation(case: dict[str, Any]) -> dict[str, Any]:
    """A case of frames less the keys that only a simulation uses, which the schema has filled."""
    used = {name: value for name, value in case.items() if name not in ("contact", "run", "seed")}
    for section, keys in USED.items():
        used[section] = {key: value for key, value in case.get(section, {}).items() if key in keys}
    if isinstance(bed := case.get("bed"), dict):
        used["bed"] = {key: value for key, value in bed.items() if key != "layers"}
    return used


@reads("frames.across", "frames.up")
def axes_differ(across: str, up: str) -> Iterator[Finding]:
    """Refuse a width and a height along the same axis."""
    if across[-1] == up[-1]:
        yield "frames.across", f"{across} is the axis of frames.up too", "take another"


@reads(
    "frames.end_s", "time.frame_interval_s", "learning.start_s", "learning.end_s", "comparison.start_s",
    "comparison.end_s",
)  # fmt: skip
def windows_lie_in_the_frames(end: float, interval: float, *windows: float) -> Iterator[Finding]:
    """Refuse windows that are empty, overlap, end after the last frame, or between frames."""
    names = ("learning.start_s", "learning.end_s", "comparison.start_s", "comparison.end_s")
    for name, time in zip(names, windows, strict=True):
        if ratio(time, interval).denominator != 1 and not is_multiple(time, interval):
            wrong = f"{time:g} s is no multiple of the time between frames ({interval:g} s)"
            yield name, wrong, f"take {nearest_multiple(time, interval):.10g}"
        if time > end:
            yield name, f"{time:g} s is after the last frame, at {end:g} s", f"take at most {end:g}"
    for at in (0, 2):
        start, last = windows[at], windows[at + 1]
        if last <= start:
            yield names[at + 1], f"{last:g} s is not after its start ({start:g} s)", "take a later end"
    if windows[2] < windows[1]:
        wrong = f"{windows[2]:g} s is inside the learning window: the chain would be tested on its own frames"
        yield names[2], wrong, f"take at least {windows[1]:g}, or an earlier learning.end_s"


@reads("frames.length_unit_m", "bed.width_m", "bed.height_m")
def frames_are_in_metres(unit: float, width: float, height: float) -> Iterator[Finding]:
    """Refuse a bed so large that lengths in the frames must have another unit."""
    if max(width, height) > LARGEST_BED_M:
        wrong = f"{unit:g} m makes a bed of {width:g} m x {height:g} m: are the frames in millimetres?"
        yield "frames.length_unit_m", wrong, f"take {unit / 1000:g}, or whatever the unit is"


@reads("frames.end_s", "comparison.repeats")
def frames_have_no_repeats(end: float, repeats: int) -> Iterator[Finding]:
    """Refuse repeats, which only a simulation can make."""
    if repeats:
        yield "comparison.repeats", f"{repeats} repeats of frames, which are there once", "take 0"
