# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings that the models are tried with: cells, lag and options of each."""

import json
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from bedchain.frames import DataError
from bedchain.grid import Grid


@dataclass(frozen=True)
class Candidate:
    """A model with one choice of everything that is free.

    Parameters
    ----------
    model : str
        A name in `models.LEARNERS`.
    columns, rows : int
        Its cells.
    lag : int
        Frames in a step.
    options : dict
        Keyword arguments of the model alone.
    """

    model: str
    columns: int
    rows: int
    lag: int
    options: dict[str, Any] = field(default_factory=dict)

    @property
    def options_text(self) -> str:
        """The options as they stand in tables; empty where there are none."""
        return json.dumps(self.options, sort_keys=True) if self.options else ""

    @property
    def key(self) -> str:
        """The whole candidate in one line, the same for the same settings."""
        return f"{self.model} {self.columns}x{self.rows} lag {self.lag} {self.options_text}".strip()


@dataclass(frozen=True)
class Settings:
    """What is tried of one model: every combination.

    Parameters
    ----------
    cells : tuple of float
        Sizes of a cell over that of the case [1].
    lags : tuple of int
        Lags over that of the case [1].
    options : tuple of dict
        Keyword arguments of the model.
    """

    cells: tuple[float, ...] = (0.5, 1, 2)
    lags: tuple[int, ...] = (1, 2, 4, 8)
    options: tuple[dict[str, Any], ...] = field(default=({},))


# A model that is not here is tried with the defaults of `Settings`. The dynamic chain needs cells finer than
# a displacement to carry the velocity, and its pairs become too many to learn from at long lags.
SETTINGS = {
    "dynamic": Settings(cells=(0.25, 0.5, 1), lags=(1, 2, 4)),
    "velocity_class": Settings(
        lags=(1, 2, 4), options=({"classes": [3, 3]}, {"classes": [5, 5]}, {"classes": [1, 5]})
    ),
}


def candidates(models: Iterable[str], case_grid: Grid, case_lag: int, resolution_m: float) -> list[Candidate]:
    """All that is tried, the case's own cells and lag among it where the settings hold 1.

    Parameters
    ----------
    models : iterable of str
        Names in `models.LEARNERS`.
    case_grid : Grid
        The case's cells.
    case_lag : int
        The case's lag [frames].
    resolution_m : float
        Cells finer than this are left out: a particle's diameter [m].

    Returns
    -------
    list of Candidate
        None twice.
    """
    found: dict[str, Candidate] = {}
    for model in models:
        settings = SETTINGS.get(model, Settings())
        for size in settings.cells:
            grid = scaled(case_grid, size)
            if not _resolved(grid, resolution_m):
                continue
            for lag in settings.lags:
                for options in settings.options:
                    one = Candidate(model, grid.columns, grid.rows, lag * case_lag, options)
                    found[one.key] = one
    return list(found.values())


def scaled(grid: Grid, size: float) -> Grid:
    """Cells ``size`` times as large on the same bed, as nearly as whole numbers of cells allow."""
    columns, rows = (max(1, round(count / size)) for count in (grid.columns, grid.rows))
    return Grid(grid.width_m, grid.height_m, columns, rows)


def grid_of(candidate: Candidate, case_grid: Grid) -> Grid:
    """The cells of a candidate on the bed of the case."""
    return Grid(case_grid.width_m, case_grid.height_m, candidate.columns, candidate.rows)


def _resolved(grid: Grid, resolution_m: float) -> bool:
    try:
        grid.check_resolution(resolution_m)
    except DataError:
        return False
    return True
