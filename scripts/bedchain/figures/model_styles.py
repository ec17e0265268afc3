# SPDX-License-Identifier: GPL-3.0-or-later
"""One colour, marker and dash for each model, the same in all figures that show many of them."""

from collections.abc import Iterable
from typing import Any, NamedTuple

BASELINE = "static_baseline"
# told apart by colour-blind readers, and by marker and dash in grey (colours: Paul Tol's bright scheme)
COLOURS = ("#ee6677", "#4477aa", "#228833", "#aa3377", "#66ccee", "#ccbb44", "#777777")
MARKERS = ("o", "^", "s", "D", "v", "P", "X")
DASHES: tuple[Any, ...] = (
    (0, (4, 1.5)), (0, (1.2, 1.2)), "-", (0, (6, 1.5, 1.2, 1.5)), (0, (8, 2)), (0, (3, 1, 1, 1)), (0, (2, 2)),
)  # fmt: skip
# they keep their styles whatever other models there are
FIRST = ("static", "dynamic")


class ModelStyle(NamedTuple):
    """How a model is drawn."""

    colour: str
    marker: str
    dash: Any


def model_styles(models: Iterable[str]) -> dict[str, ModelStyle]:
    """Styles by model; the baseline shares that of the static chain.

    Parameters
    ----------
    models : iterable of str
        In any order, perhaps with doubles.

    Returns
    -------
    dict of str to ModelStyle
        In a fixed order: static and dynamic, then the others by name.
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
