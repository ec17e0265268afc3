# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of the chains of the trade-off: each cell size with each lag, all else varied one at a time."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from itertools import product
from typing import Any

from bedchain.case.presets import count_near
from bedchain.chains.estimators import ESTIMATORS
from bedchain.errors import DataError
from bedchain.measures.mixing import Splits
from bedchain.studies.candidates import Candidate, grid_of, is_resolved
from bedchain.trajectory.frames import lag_frames
from bedchain.trajectory.grid import Grid

CELL_SIZES_M = (0.0025, 0.005, 0.01, 0.02, 0.03, 0.05)
LAGS_S = (0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.0)
# width and height of a cell over those of the case's cells
SHAPES = ((0.25, 4), (0.5, 2), (2, 0.5), (4, 0.25))
WINDOWS_S = (0.5, 1.0, 2.0, 3.0, 5.0)
# where a window half as long as the case's begins, as a share of the case's
BEGINNINGS = (0.0, 0.25, 0.5)
# the dynamic chain takes gigabytes on finer cells: size of its cells and its lag over those of the case
DYNAMIC = ((1, 1), (1, 2), (1, 4), (2, 1), (2, 2))
TRACERS = (100, 1000, 10_000, 100_000, 1_000_000)
FACTORIAL, ORDER = "cells and lag", "order"


@dataclass(frozen=True)
class ChainSetting:
    """Setting of one chain and of its run.

    Parameters
    ----------
    axis : str
        Setting that is varied.
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
        """The setting in one line."""
        return " ".join(str(value) for value in asdict(self).values())


@dataclass(frozen=True)
class CaseChain:
    """The chain of the case, from which the settings differ.

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
        Of a particle, the smallest size of a cell [m].
    splits : Splits
        Lines between left and right, low and up [m].
    models : tuple of str
        Of the case; of these, the paper's are studied.
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
        """Columns and rows of cells that are this many times as wide and as high as the case's [1]."""
        return self.near(self.grid.cell_width_m * wide, self.grid.cell_height_m * high)


def chain_settings(base: CaseChain) -> list[ChainSetting]:
    """Settings that the case's windows and particles allow, ordered by cells.

    Parameters
    ----------
    base : CaseChain

    Returns
    -------
    list of ChainSetting
        Each once; the chain of the case is in the axis `FACTORIAL`.
    """
    by_values: dict[tuple[Any, ...], ChainSetting] = {}
    for axis, changes in _changes(base):
        defaults = {
            "model": "static", "columns": base.grid.columns, "rows": base.grid.rows, "lag": base.lag,
            "estimator": base.estimator, "first": base.learning.start, "last": base.learning.stop - 1,
        }  # fmt: skip
        setting = ChainSetting(axis, **defaults | changes)
        longest = min(setting.last - setting.first, base.compared)
        if (
            is_resolved(grid_of(setting.candidate, base.grid), base.diameter_m)
            and setting.lag * (2 if setting.model == "dynamic" else 1) <= longest
        ):
            by_values.setdefault(tuple(asdict(setting).values())[1:], setting)
    return sorted(by_values.values(), key=lambda setting: (setting.columns, setting.rows))


def _changes(base: CaseChain) -> Iterator[tuple[str, dict[str, Any]]]:
    yield FACTORIAL, {}
    base_cells = base.grid.columns, base.grid.rows
    for (columns, rows), lag in product([base_cells, *map(base.near, CELL_SIZES_M)], lags(base)):
        yield FACTORIAL, {"columns": columns, "rows": rows, "lag": lag}
    for wide, high in SHAPES:
        columns, rows = base.scaled(wide, high)
        yield "cell shape", {"columns": columns, "rows": rows}
    for name in ESTIMATORS:
        yield "estimator", {"estimator": name}
    for length in (round(length_s / base.interval_s) for length_s in WINDOWS_S):
        if length < base.frames:
            yield "window", {"first": base.learning.stop - 1 - length}
    for share in BEGINNINGS:
        first, half = base.learning.start + round(share * base.frames), base.frames // 2
        yield "window start", {"first": first, "last": min(first + half, base.learning.stop - 1)}
    for size, lag in DYNAMIC if "dynamic" in base.models else ():
        columns, rows = base.scaled(size, size) if size != 1 else base_cells
        yield ORDER, {"model": "dynamic", "columns": columns, "rows": rows, "lag": lag * base.lag}
    for tracers in TRACERS:
        yield "tracers", {"tracers": tracers}


def lags(base: CaseChain) -> list[int]:
    """The case's lag and those of `LAGS_S` that are whole numbers of frames [frames]."""
    whole = [base.lag]
    for lag_s in LAGS_S:
        try:
            whole.append(lag_frames(lag_s, base.interval_s))
        except DataError:
            continue
    return whole
