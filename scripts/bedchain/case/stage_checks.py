# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of what later stages ask of a case: lags in windows, moments on steps, colours that exist."""

from collections.abc import Iterator

from bedchain.case.check_registry import Finding, reads
from bedchain.case.schema import load_schema, schema_keys
from bedchain.physics.whole_numbers import is_multiple, nearest_multiple, ratio, span

WINDOWS = ("learning.start_s", "learning.end_s", "comparison.start_s", "comparison.end_s")
HISTORY_LAGS = 4  # before the comparison, that a chain is given (`trajectory.realisations`)
# defaults of the schema, which need no import of Matplotlib: it takes 0.3 s
USUAL_MAPS = ("YlGnBu", "coolwarm")
COLOURS = tuple(
    f"figures.{name}_colour"
    for name in (
        "cells", "cost", "dem", "static", "dynamic", "left", "right", "velocity_class", "jump", "recurrence",
        "chosen",
    )
)  # fmt: skip
MAPS = ("figures.distribution_colour_map", "figures.snapshot_colour_map")


@reads("figures.moments_s")
def moments_rise(moments: list[float]) -> Iterator[Finding]:
    """Refuse moments that do not rise."""
    if moments != sorted(set(moments)):
        yield "figures.moments_s", "the moments do not rise", f"take {sorted(set(moments))}"


@reads("chain.models", "discussion.lags_s", "time.frame_interval_s", *WINDOWS)
def lags_of_the_discussion_fit(
    models: list[str], lags: list[float], frame: float, *ends: float
) -> Iterator[Finding]:
    """Refuse lags of the discussion none of which fits the frames and divides both windows.

    Of the schema's lags none needs to fit: the case's own is always discussed.
    """
    if lags == schema_keys(load_schema())["discussion.lags_s"]["default"]:
        return
    if not {"static", "dynamic"} & set(models) or not (ends[0] < ends[1] and ends[2] < ends[3]):
        return
    spans = [span(*ends[:2]), span(*ends[2:])]
    if not any(
        is_multiple(lag, frame) and all((length / ratio(lag, 1.0)).denominator == 1 for length in spans)
        for lag in lags
    ):
        wrong = (
            f"none of {', '.join(f'{lag:g}' for lag in lags)} s is a multiple of time.frame_interval_s "
            f"({frame:g} s) that divides the learning window and the comparison"
        )
        yield "discussion.lags_s", wrong, f"take [{frame:g}], or more"


@reads("chain.models", "chain.velocity_class.earlier_s", "chain.lag_s", "time.frame_interval_s", *WINDOWS)
def earlier_velocities_are_in_the_window(
    models: list[str], earlier: float, lag: float, frame: float, *ends: float
) -> Iterator[Finding]:
    """Refuse an earlier velocity between frames, before all history, or longer ago than the window."""
    if "velocity_class" not in models or not earlier or not ends[0] < ends[1]:
        return
    if not is_multiple(earlier, frame):
        wrong = f"{earlier:g} s is no multiple of time.frame_interval_s ({frame:g} s)"
        yield "chain.velocity_class.earlier_s", wrong, f"take {nearest_multiple(earlier, frame):.10g}"
    most = min(HISTORY_LAGS * ratio(lag, 1.0), span(ends[0], ends[1]) - ratio(lag, 1.0))
    if ratio(earlier, 1.0) > most:
        wrong = f"{earlier:g} s is more than {HISTORY_LAGS} lags, or than the learning window less a lag"
        yield (
            "chain.velocity_class.earlier_s",
            wrong,
            f"take at most {max(0.0, float(most)):g}, or a longer lag",
        )


@reads("chain.models", "chain.recurrence.separation_s", "chain.lag_s", "learning.start_s", "learning.end_s")
def jumps_of_the_recurrence_have_targets(
    models: list[str], separation: float, lag: float, start: float, end: float
) -> Iterator[Finding]:
    """Refuse a separation for which a frame in the middle of the window has no frame to jump to."""
    usable = span(start, end) - ratio(lag, 1.0)
    if "recurrence" in models and 0 < usable < 2 * ratio(separation, 1.0):
        wrong = f"{separation:g} s is above half of the learning window less a lag, {float(usable):g} s"
        yield "chain.recurrence.separation_s", wrong, f"take at most {float(usable) / 2:g}"


@reads(*COLOURS)
def colours_exist(*colours: str) -> Iterator[Finding]:
    """Refuse colours that Matplotlib does not know."""
    for key, colour in zip(COLOURS, colours, strict=True):
        if not colour.startswith("#"):
            from matplotlib.colors import is_color_like  # slow to import, and seldom needed

            if not is_color_like(colour):
                yield key, f"{colour!r} is no colour of Matplotlib", "take one such as '#4477aa' or teal"


@reads(*MAPS)
def colour_maps_exist(*maps: str) -> Iterator[Finding]:
    """Refuse colour maps that Matplotlib does not know."""
    for key, name in zip(MAPS, maps, strict=True):
        if name not in USUAL_MAPS:
            from matplotlib import colormaps  # likewise

            if name not in colormaps:
                yield key, f"{name!r} is no colour map of Matplotlib", "take one such as YlGnBu or viridis"
