# SPDX-License-Identifier: GPL-3.0-or-later
"""The chains whose cost and errors are measured: every cell size with every lag, the rest one at a time."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from itertools import product
from typing import Any

from bedchain.case.presets import count_near
from bedchain.chains.estimators import ESTIMATORS
from bedchain.errors import DataError
from bedchain.measures.mixing import Splits
from bedchain.studies.scores.candidates import Candidate
from bedchain.trajectory.frames import lag_frames
from bedchain.trajectory.grid import Grid

CELL_SIZES_M = (0.0025, 0.005, 0.01, 0.02, 0.03, 0.05)
LAGS_S = (0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.0)
# width and height of a cell over those of the case's own
SHAPES = ((0.25, 4), (0.5, 2), (2, 0.5), (4, 0.25))
WINDOWS_S = (0.5, 1.0, 2.0, 3.0, 5.0)
# where a window half as long as the case's begins, as a share of the case's
BEGINNINGS = (0.0, 0.25, 0.5)
# the dynamic chain takes gigabytes on finer cells: size of its cells and its lag over the case's own
DYNAMIC = ((1, 1), (1, 2), (1, 4), (2, 1), (2, 2))
TRACERS = (100, 1000, 10_000, 100_000, 1_000_000)
FACTORIAL, ORDER = "cells and lag", "order"


@dataclass(frozen=True)
class Setting:
    """One chain, and how it is run.

    Parameters
    ----------
    axis : str
        What is varied.
    model : str
        A name in `registry.LEARNERS`.
    columns, rows : int
        Its cells.
    lag : int
        Frames in a step.
    estimator : {"literal", "per_step", "pooled"}
        How counts become probabilities.
    first, last : int
        Frames of the run that it is learned from, both included.
    tracers : int
        Particles of a Monte Carlo; 0 for the exact expectation.
    """

    axis: str
    model: str
    columns: int
    rows: int
    lag: int
    estimator: str
    first: int
    last: int
    tracers: int = 0

    @property
    def candidate(self) -> Candidate:
        """The chain without its learning window."""
        return Candidate(self.model, self.columns, self.rows, self.lag)

    @property
    def key(self) -> str:
        """The whole setting in one line."""
        return " ".join(str(value) for value in asdict(self).values())


@dataclass(frozen=True)
class Own:
    """The case's own chain, which the settings vary.

    Parameters
    ----------
    grid : Grid
    lag : int
        Frames in a step.
    estimator : str
    learning : slice
        Frames of the learning window.
    compared : int
        Frame intervals in the comparison window.
    interval_s : float
        Between two frames [s].
    diameter_m : float
        Of a particle: no cell is smaller [m].
    splits : Splits
    models : tuple of str
        The case's, those of the paper among which are studied.
    """

    grid: Grid
    lag: int
    estimator: str
    learning: slice
    compared: int
    interval_s: float
    diameter_m: float
    splits: Splits
    models: tuple[str, ...] = ("static", "dynamic")

    @property
    def frames(self) -> int:
        """Frame intervals in the learning window."""
        return self.learning.stop - self.learning.start - 1

    def near(self, width_m: float, height_m: float | None = None) -> tuple[int, int]:
        """Columns and rows of cells of about a size, square without a height [1]; see `count_near`."""
        grid, (split_x, split_z) = self.grid, self.splits
        columns = count_near(grid.width_m, width_m, split_x, grid.columns, self.diameter_m)
        high = width_m if height_m is None else height_m
        return columns, count_near(grid.height_m, high, split_z, grid.rows, self.diameter_m)

    def scaled(self, wide: float, high: float) -> tuple[int, int]:
        """Columns and rows of cells so many times as wide and as high as the case's own [1]."""
        return self.near(self.grid.cell_width_m * wide, self.grid.cell_height_m * high)


def settings(own: Own) -> list[Setting]:
    """All settings that the case's windows and particles allow, those of the same cells together.

    Parameters
    ----------
    own : Own

    Returns
    -------
    list of Setting
        None twice; the case's own chain is in the axis `FACTORIAL`.
    """
    found: dict[tuple[Any, ...], Setting] = {}
    for axis, changes in _changes(own):
        made = {
            "model": "static", "columns": own.grid.columns, "rows": own.grid.rows, "lag": own.lag,
            "estimator": own.estimator, "first": own.learning.start, "last": own.learning.stop - 1,
        }  # fmt: skip
        setting = Setting(axis, **made | changes)
        longest = min(setting.last - setting.first, own.compared)
        if _resolved(own, setting) and setting.lag * (2 if setting.model == "dynamic" else 1) <= longest:
            found.setdefault(tuple(asdict(setting).values())[1:], setting)
    return sorted(found.values(), key=lambda one: (one.columns, one.rows))


def _changes(own: Own) -> Iterator[tuple[str, dict[str, Any]]]:
    yield FACTORIAL, {}
    own_cells = own.grid.columns, own.grid.rows
    for (columns, rows), lag in product([own_cells, *map(own.near, CELL_SIZES_M)], lags(own)):
        yield FACTORIAL, {"columns": columns, "rows": rows, "lag": lag}
    for wide, high in SHAPES:
        columns, rows = own.scaled(wide, high)
        yield "cell shape", {"columns": columns, "rows": rows}
    for name in ESTIMATORS:
        yield "estimator", {"estimator": name}
    for length in (round(length_s / own.interval_s) for length_s in WINDOWS_S):
        if length < own.frames:
            yield "window", {"first": own.learning.stop - 1 - length}
    for share in BEGINNINGS:
        first, half = own.learning.start + round(share * own.frames), own.frames // 2
        yield "window start", {"first": first, "last": min(first + half, own.learning.stop - 1)}
    for size, lag in DYNAMIC if "dynamic" in own.models else ():
        columns, rows = own.scaled(size, size) if size != 1 else own_cells
        yield ORDER, {"model": "dynamic", "columns": columns, "rows": rows, "lag": lag * own.lag}
    for tracers in TRACERS:
        yield "tracers", {"tracers": tracers}


def lags(own: Own) -> list[int]:
    """The case's own lag and those of `LAGS_S` that are whole numbers of frames [frames]."""
    found = [own.lag]
    for lag_s in LAGS_S:
        try:
            found.append(lag_frames(lag_s, own.interval_s))
        except DataError:
            continue
    return found


def _resolved(own: Own, setting: Setting) -> bool:
    try:
        grid = Grid(own.grid.width_m, own.grid.height_m, setting.columns, setting.rows)
        grid.check_resolution(own.diameter_m)
    except DataError:
        return False
    return True
