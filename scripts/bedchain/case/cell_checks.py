# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of the cells: a form that goes with the bed and the chains, a number and sizes that can be."""

from collections.abc import Iterator

from bedchain.case.check_registry import Finding, reads
from bedchain.physics.whole_numbers import ratio

# of a chain: 2 million and as many moves of a million particles as occur in 20 frames take 2.1 GB
MOST_CELLS = 4_000_000
PI = 3.141592653589793
FORMS = ("cells.form", "cells.axis")
COUNTS = ("cells.columns", "cells.rows", "cells.layers")
BED = ("bed.width_m", "bed.height_m", "bed.thickness_m")
FLAT_MODELS = ("jump", "recurrence")  # they draw displacements along x and z


@reads(*COUNTS)
def cells_can_be_counted(columns: int, rows: int, layers: int) -> Iterator[Finding]:
    """Refuse more cells than a chain can have."""
    if columns * rows > MOST_CELLS:
        wrong = f"{columns} x {rows} cells are {columns * rows}, more than {MOST_CELLS}"
        yield "cells.rows", wrong, f"take at most {MOST_CELLS // columns} rows, or fewer columns"
    elif columns * rows * layers > MOST_CELLS:
        wrong = f"{columns} x {rows} x {layers} cells are {columns * rows * layers}, more than {MOST_CELLS}"
        yield "cells.layers", wrong, f"take at most {MOST_CELLS // (columns * rows)} layers"


@reads(*FORMS, *COUNTS, *BED, "particles.diameter_m")
def cells_hold_particles(form: str, axis: str, *numbers: float) -> Iterator[Finding]:
    """Refuse cells narrower than a particle."""
    counts, (width, height, depth, diameter) = numbers[:3], numbers[3:]
    radius, turn, vertical = width / 2, PI * width, axis == "vertical"
    lengths = {
        "boxes": (width, height, depth),
        "rings": (radius, height if vertical else depth, depth),
        "sectors": (turn, height, radius) if vertical else (turn, radius, depth),
    }[form]
    for name, cells, length in zip(("columns", "rows", "layers"), counts, lengths, strict=True):
        if ratio(length, diameter) < cells and (name != "layers" or cells > 1):
            wrong = f"{cells} cells over {length:g} m are narrower than a particle ({diameter:g} m)"
            yield f"cells.{name}", wrong, f"take at most {int(ratio(length, diameter))}"


@reads(*FORMS, "cells.layers", *BED, "scene")
def round_cells_fit_the_bed(
    form: str, axis: str, layers: int, width: float, height: float, depth: float, scene: str
) -> Iterator[Finding]:
    """Refuse rings and sectors in a bed that is not round about their axis, and layers of rings."""
    if form == "boxes":
        return
    if layers > 1 and form == "rings":
        yield "cells.layers", f"{layers} layers of rings: they have columns and rows only", "leave it out"
    if scene.startswith("drum") and axis == "vertical":
        yield "cells.form", f"{form} about a vertical axis in a drum, whose axis lies", "add axis: horizontal"
        return
    name, other = ("thickness_m", depth) if axis == "vertical" else ("height_m", height)
    if width != other:
        wrong = f"{form} about a {axis} axis in a bed {width:g} m wide, with bed.{name} {other:g} m"
        yield "cells.form", wrong, "make both as long as the cylinder is wide, or take boxes"


@reads(*FORMS, "cells.layers", "chain.models")
def models_go_with_the_cells(form: str, axis: str, layers: int, models: list[str]) -> Iterator[Finding]:
    """Refuse chains that draw displacements in a plane, where cells are no boxes of that plane."""
    flat = [model for model in models if model in FLAT_MODELS]
    if flat and (form != "boxes" or layers > 1):
        cells = "boxes in layers" if form == "boxes" else form
        wrong = f"{', '.join(flat)} knows places along x and z only, and the cells are {cells}"
        yield "chain.models", wrong, "leave it out, or take flat boxes"


def not_flat(form: str = "boxes", layers: int = 1, outside: str = "refuse") -> str:
    """Reason why chains of other cells cannot be studied beside those of a case; empty where they can.

    Parameters
    ----------
    form, layers
        Of the cells of the case.
    outside : {"refuse", "exit"}
        Whether particles may leave the bed.
    """
    if form != "boxes" or layers > 1:
        cells = "boxes in layers" if form == "boxes" else form
        return f"other cells and lags are studied on flat boxes only, and the cells are {cells}"
    if outside == "exit":
        return "other cells and lags are studied in closed beds only, and particles may leave this one"
    return ""
