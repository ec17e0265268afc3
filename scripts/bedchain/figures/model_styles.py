# SPDX-License-Identifier: GPL-3.0-or-later
"""Colour, marker and dash of each model, the same in all figures of many models."""

from collections.abc import Iterable
from typing import Any, NamedTuple

BASELINE = "static_baseline"
# Paul Tol's bright scheme, distinct for colour-blind readers; in grey the markers and dashes differ
COLOURS = ("#ee6677", "#4477aa", "#228833", "#aa3377", "#66ccee", "#ccbb44", "#777777")
MARKERS = ("o", "^", "s", "D", "v", "P", "X")
DASHES: tuple[Any, ...] = (
    (0, (4, 1.5)), (0, (1.2, 1.2)), "-", (0, (6, 1.5, 1.2, 1.5)), (0, (8, 2)), (0, (3, 1, 1, 1)), (0, (2, 2)),
)  # fmt: skip
# always with the first two styles
FIRST = ("static", "dynamic")


class ModelStyle(NamedTuple):
    """Style of a model's curves and points."""

    colour: str
    marker: str
    dash: Any


def model_styles(models: Iterable[str]) -> dict[str, ModelStyle]:
    """Styles by model; the baseline has that of the static chain.

    Parameters
    ----------
    models : iterable of str
        In any order; repeated names are allowed.

    Returns
    -------
    dict of str to ModelStyle
        Static and dynamic first, then the others by name.
    """
    others = sorted({*models} - {*FIRST, BASELINE})
    names = [*FIRST, *others]
    styles = {
        name: ModelStyle(
            COLOURS[number % len(COLOURS)], MARKERS[number % len(MARKERS)], DASHES[number % len(DASHES)]
        )
        for number, name in enumerate(names)
    }
    return styles | {BASELINE: styles["static"]}


def label(model: str) -> str:
    """Name of a model in a legend."""
    return "static, as in the paper" if model == BASELINE else f"{model.replace('_', ' ')} chain"
