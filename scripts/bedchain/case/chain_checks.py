# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of the chains: windows, lag, cells, repeats, dividing lines, and moments of the figures."""

from collections.abc import Iterator

from bedchain.case.check_registry import Finding, reads
from bedchain.physics.whole_numbers import is_multiple, nearest_multiple, ratio, span


@reads(
    "learning.start_s",
    "learning.end_s",
    "comparison.start_s",
    "comparison.end_s",
    "time.end_s",
    "time.frame_interval_s",
)
def windows_lie_in_time(
    learn_start: float, learn_end: float, compare_start: float, compare_end: float, end: float, frame: float
) -> Iterator[Finding]:
    """Refuse windows outside the simulated time, between frames, or overlapping."""
    for name, first, last in (
        ("learning", learn_start, learn_end),
        ("comparison", compare_start, compare_end),
    ):
        if last <= first:
            yield f"{name}.end_s", f"{last:g} s is not after {name}.start_s ({first:g} s)", "take a later end"
        if last > end:
            wrong = f"{last:g} s is outside the simulated time, 0 to {end:g} s"
            yield f"{name}.end_s", wrong, f"take at most {end:g}, or raise time.end_s to {last:g}"
        for edge, time in (("start_s", first), ("end_s", last)):
            if ratio(time, frame).denominator != 1:
                wrong = f"{time:g} s is no multiple of time.frame_interval_s ({frame:g} s)"
                yield f"{name}.{edge}", wrong, f"take {nearest_multiple(time, frame):.10g}"
    if compare_start < learn_end:
        wrong = (
            f"{compare_start:g} s is inside the learning window, {learn_start:g} to {learn_end:g} s: "
            "the chain would be tested on the frames that it was learned from"
        )
        yield "comparison.start_s", wrong, f"take at least {learn_end:g}, or an earlier learning.end_s"


@reads("discussion.cell_sizes_m", "particles.diameter_m")
def cells_of_the_discussion_hold_particles(sizes: list[float], diameter: float) -> Iterator[Finding]:
    """Refuse cell sizes of the discussion below a particle diameter."""
    for size in sizes:
        if size < diameter:
            wrong = f"{size:g} m is smaller than a particle ({diameter:g} m)"
            yield "discussion.cell_sizes_m", wrong, f"take at least {diameter:g}"


@reads("chain.models", "chain.recurrence.coarse_m", "particles.diameter_m")
def cells_of_the_recurrence_hold_particles(
    models: list[str], size: float, diameter: float
) -> Iterator[Finding]:
    """Refuse cells of the recurrence chain below a particle diameter: frames would be compared for weeks."""
    if "recurrence" in models and size < diameter:
        wrong = f"{size:g} m is smaller than a particle ({diameter:g} m)"
        yield "chain.recurrence.coarse_m", wrong, f"take at least {diameter:g}"


@reads("comparison.repeats", "comparison.start_s", "time.segment_s", "gas.model")
def repeats_start_at_a_segment(
    repeats: int, start: float, segment: float, gas_model: str
) -> Iterator[Finding]:
    """Refuse repeats without gas, or that start inside a segment: its state is kept at the end only."""
    if repeats and gas_model == "none":
        yield (
            "comparison.repeats",
            f"{repeats} repeats of a scene without gas",
            "take 0: only beds with gas are repeated",
        )
    if repeats and not is_multiple(start, segment):
        wrong = f"{repeats} repeats cannot start at comparison.start_s ({start:g} s), within a segment"
        yield "comparison.repeats", wrong, f"take a time.segment_s that divides {start:g}, or 0 repeats"


@reads(
    "chain.lag_s",
    "time.frame_interval_s",
    "learning.start_s",
    "learning.end_s",
    "comparison.start_s",
    "comparison.end_s",
)
def lag_fits(
    lag: float, frame: float, learn_start: float, learn_end: float, compare_start: float, compare_end: float
) -> Iterator[Finding]:
    """Refuse a lag that is no multiple of the frame interval, or too long for the windows."""
    if not is_multiple(lag, frame):
        wrong = f"{lag:g} s is no multiple of time.frame_interval_s ({frame:g} s)"
        yield "chain.lag_s", wrong, f"take {nearest_multiple(lag, frame):.10g}"
    shorter = min(span(learn_start, learn_end), span(compare_start, compare_end))
    if 0 < shorter < 2 * ratio(lag, 1.0):
        wrong = f"{lag:g} s: the shorter window ({float(shorter):g} s) holds less than two lags"
        yield "chain.lag_s", wrong, "take a shorter lag or longer windows; the dynamic chain needs two lags"


@reads("mixing.split_x_m", "mixing.split_z_m", "figures.batch_height_m", "bed.width_m", "bed.height_m")
def splits_lie_in_bed(
    split_x: float, split_z: float, batch: float, width: float, height: float
) -> Iterator[Finding]:
    """Refuse dividing lines and a batch outside the bed."""
    lines = [
        ("mixing.split_x_m", split_x, "width_m", width),
        ("mixing.split_z_m", split_z, "height_m", height),
    ]
    for key, place, name, length in [*lines, ("figures.batch_height_m", batch, "height_m", height)]:
        if place >= length:
            yield (
                key,
                f"{place:g} m is outside the bed (bed.{name} {length:g} m)",
                f"take less than {length:g}",
            )


@reads("figures.moments_s", "time.frame_interval_s", "comparison.start_s", "comparison.end_s")
def moments_are_frames(moments: list[float], frame: float, start: float, end: float) -> Iterator[Finding]:
    """Refuse moments that are no frames, or after the comparison."""
    for moment in moments:
        if not is_multiple(moment, frame):
            wrong = f"{moment:g} s is no multiple of time.frame_interval_s ({frame:g} s)"
            yield "figures.moments_s", wrong, f"take {nearest_multiple(moment, frame):.10g}"
        if 0 < span(start, end) < ratio(moment, 1.0):
            wrong = f"{moment:g} s is after the end of the comparison, which lasts {end - start:g} s"
            yield "figures.moments_s", wrong, "leave it out, or take a later comparison.end_s"
