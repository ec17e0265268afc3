# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of the size of a case: lengths in metres; steps, frames and segments that can be counted."""

from collections.abc import Iterator

from bedchain.case.check_registry import Finding, reads
from bedchain.physics.whole_numbers import ratio

MILLIMETRE_M = 1e-3
LARGEST_BED_M = 10.0  # no bed of the literature that is simulated particle by particle is wider or higher
LARGEST_PARTICLE_M = 0.1
MOST_STEPS = 2**31 - 1  # that a run of LIGGGHTS can count
MOST_FRAMES = 100_000
MOST_SEGMENTS = 9_999  # their folders have four digits


@reads("bed.width_m", "bed.height_m", "bed.thickness_m", "particles.diameter_m")
def lengths_are_in_metres(
    width: float, height: float, thickness: float, diameter: float
) -> Iterator[Finding]:
    """Refuse a bed or particles so large that their lengths must be millimetres."""
    lengths = [
        ("bed.width_m", width, "wide", LARGEST_BED_M),
        ("bed.height_m", height, "high", LARGEST_BED_M),
        ("particles.diameter_m", diameter, "in diameter", LARGEST_PARTICLE_M),
    ]
    if thickness != diameter:  # its default
        lengths.append(("bed.thickness_m", thickness, "thick", LARGEST_BED_M))
    for key, length, way, most in lengths:
        if length > most:
            wrong = f"{length:g} m {way}: were millimetres meant?"
            yield key, wrong, f"{length:g} mm are {length * MILLIMETRE_M:g} here; at most {most:g} m"


@reads("time.dem_step_s", "time.settle_s", "time.frame_interval_s", "time.segment_s", "time.end_s")
def steps_can_be_counted(
    dem: float, settle: float, frame: float, segment: float, end: float
) -> Iterator[Finding]:
    """Refuse more steps, frames or segments than a run can have."""
    counts = [
        ("settle_s", settle, dem, "steps of time.dem_step_s", MOST_STEPS),
        ("end_s", end, dem, "steps of time.dem_step_s", MOST_STEPS),
        ("end_s", end, frame, "frames (time.frame_interval_s)", MOST_FRAMES),
        ("end_s", end, segment, "segments (time.segment_s)", MOST_SEGMENTS),
    ]
    for name, length, unit, items, most in counts:
        if (number := ratio(length, unit)) > most:
            wrong = f"{length:g} s are {float(number):.3g} {items} of {unit:g} s, more than {most}"
            yield f"time.{name}", wrong, f"take at most {most * unit:.3g} s, or longer ones"
