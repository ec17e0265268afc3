# SPDX-License-Identifier: GPL-3.0-or-later
"""The cells of a chain by rule: the largest that add little to the particles' dispersion over its lag.

What they add is h^2 E[f (1 - f)] / (2 lag) (`numerical_dispersion`); on every axis it must be below 5 % of
the particles'.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bedchain.case.presets import FEWEST_CELLS, LEVEL_DIAMETERS
from bedchain.measures.choice import GIVE, Array
from bedchain.measures.dispersion_by_lag import thinned
from bedchain.measures.numerical_dispersion import added_share
from bedchain.physics.whole_numbers import ratio

MOST_ADDED = 0.05  # of the particles' dispersion, by the cells
MOST_ELONGATED = 1.25  # longer over shorter side of a cell


@dataclass(frozen=True)
class ChosenCells:
    """Cells by rule.

    Parameters
    ----------
    columns, rows : int
    added : (2,) array
        Their added dispersion over the particles', along x and z [1].
    tried : list of (cell_m, x share, z share)
        All cells that were looked at.
    doubt : str
        Why they cannot be trusted; empty where they can.
    """

    columns: int
    rows: int
    added: Array
    tried: list[tuple[float, float, float]]
    doubt: str = ""


def choose_cells(
    places_m: tuple[NDArray[np.floating], NDArray[np.floating]], size_m: tuple[float, float],
    lines_m: Sequence[float], diameter_m: float, lag: int,
) -> ChosenCells:  # fmt: skip
    """The largest nearly square cells whose added dispersion is below `MOST_ADDED` on every axis.

    Parameters
    ----------
    places_m : two (n_frames, n_particles) arrays
        Positions along x and z [m].
    size_m : (float, float)
        Width and height of the bed [m].
    lines_m : (float, float)
        Lines between the marked groups [m]; no cell is higher than what is below the second.
    diameter_m : float
        Of a particle: no cell is smaller; sides are whole halves of it where those divide the bed [m].
    lag : int
        [frames].

    Returns
    -------
    ChosenCells
        The smallest cells there are, with a doubt, where none adds so little.
    """
    fine = [thinned(place) for place in places_m]
    counts = [counts_of(*side, diameter_m) for side in zip(size_m, lines_m, strict=True)]
    tried = []
    shapes = sorted(_shapes(counts, size_m))
    for side, *shape in shapes:
        sizes = [length_m / count for length_m, count in zip(size_m, shape, strict=True)]
        x, z = (added_share(place, size, lag) for place, size in zip(fine, sizes, strict=True))
        tried.append((side, x, z))
    fit = [number for number, (_, *shares) in enumerate(tried) if max(shares) < MOST_ADDED]
    side, columns, rows = shapes[fit[-1] if fit else 0]
    added = np.array(tried[fit[-1] if fit else 0][1:])
    doubt = ""
    if not fit:
        doubt = (
            f"even the smallest cells, {side:.3g} m, add {added.max():.0%} to the particles' dispersion, "
            f"more than {MOST_ADDED:.0%}: the lag is too short for cells that hold particles; {GIVE}"
        )
    return ChosenCells(columns, rows, added, tried, doubt)


def counts_of(length_m: float, line_m: float, diameter_m: float) -> list[int]:
    """Numbers of cells along a side of the bed that may be chosen, rising; at least one.

    Parameters
    ----------
    length_m, line_m, diameter_m : float
        Of the side, of the line between two groups on it, and of a particle [m].
    """
    levels = ratio(length_m, LEVEL_DIAMETERS * diameter_m)
    most = max(1, int(ratio(length_m, diameter_m)))
    least = min(most, max(FEWEST_CELLS, math.ceil(ratio(length_m, line_m))))
    counts = range(least, most + 1)
    whole = [count for count in counts if levels.denominator == 1 and levels % count == 0]
    return whole or list(counts)


def _shapes(counts: list[list[int]], size_m: tuple[float, float]) -> list[tuple[float, int, int]]:
    """Side of a square as large as the cell [m], columns and rows, of each number of columns.

    Of all rows those whose cells are the most nearly square; left out where they are too long.
    """
    (width_m, height_m), rows_known = size_m, np.array(counts[1])
    elongation = {}
    for columns in counts[0]:
        ratios = np.abs(np.log(height_m / rows_known * columns / width_m))
        rows = int(rows_known[ratios.argmin()])
        side = math.sqrt(width_m / columns * height_m / rows)
        elongation[side, columns, rows] = float(ratios.min())
    square = [shape for shape, off in elongation.items() if off <= math.log(MOST_ELONGATED)]
    return square or [min(elongation, key=lambda shape: elongation[shape])]
