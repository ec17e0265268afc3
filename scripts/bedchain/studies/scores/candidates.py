# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings that the models are tried with: cells, lag and options of each."""

import json
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import product
from typing import Any

from bedchain.errors import DataError
from bedchain.trajectory.grid import Grid


@dataclass(frozen=True)
class Candidate:
    """A model with one choice of everything that is free.

    Parameters
    ----------
    model : str
        A name in `registry.LEARNERS`.
    columns, rows : int
        Its cells.
    lag : int
        Frames in a step.
    options : dict
        Keyword arguments of the model alone.
    family : str
        What it competes as, where one model stands for several; its model by default.
    """

    model: str
    columns: int
    rows: int
    lag: int
    options: dict[str, Any] = field(default_factory=dict)
    family: str = ""

    @property
    def name(self) -> str:
        """What it competes as: of each name one setting is chosen."""
        return self.family or self.model

    @property
    def options_text(self) -> str:
        """The options as they stand in tables; empty where there are none."""
        return json.dumps(self.options, sort_keys=True) if self.options else ""

    @property
    def key(self) -> str:
        """The whole candidate in one line, the same for the same settings."""
        return f"{self.name} {self.columns}x{self.rows} lag {self.lag} {self.options_text}".strip()


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
    family : str
        What all these compete as, where one model stands for several.
    """

    cells: tuple[float, ...] = (0.5, 1, 2)
    lags: tuple[int, ...] = (1, 2, 4, 8)
    options: tuple[dict[str, Any], ...] = field(default=({},))
    family: str = ""


# Classes of the velocity along x and z: none, of both alike, of the height alone.
CLASSES = ({"classes": [1, 1]}, {"classes": [3, 3]}, {"classes": [5, 5]}, {"classes": [1, 5]})
# A model that is not here is tried with the defaults of `Settings`. The dynamic chain needs cells finer than
# a displacement to carry the velocity, and its pairs become too many to learn from at long lags.
# The recurrence chain does not use the cells; its two baselines compete as models of their own.
SETTINGS: dict[str, tuple[Settings, ...]] = {
    # Finer cells here, and fine cells by many classes, take more than a gigabyte on the paper's bed.
    "dynamic": (Settings((0.5,), (1, 2)), Settings((1,), (1, 2, 4))),
    "velocity_class": (
        Settings((0.5,), (1, 2), CLASSES[1:2]),
        Settings((1, 2), (1, 2, 4), CLASSES[1:]),
    ),
    "jump": (Settings((1, 2), (1, 2, 4), CLASSES),),
    "recurrence": (
        Settings((1,), (2, 4), ({"segment_s": 0.2}, {"segment_s": 0.5}, {"segment_s": 1.0})),
        Settings((1,), (4,), ({"order": "shuffled"},), "recurrence_shuffled"),
        Settings((1,), (4,), ({"order": "replay"},), "recurrence_replay"),
    ),
}


def candidates(models: Iterable[str], case_grid: Grid, case_lag: int, resolution_m: float) -> list[Candidate]:
    """All that is tried, the case's own cells and lag among it where the settings hold 1.

    Parameters
    ----------
    models : iterable of str
        Names in `registry.LEARNERS`.
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
        for tried in SETTINGS.get(model, (Settings(),)):
            for size, lag, options in product(tried.cells, tried.lags, tried.options):
                grid = scaled(case_grid, size)
                if _resolved(grid, resolution_m):
                    shape = (grid.columns, grid.rows, lag * case_lag)
                    one = Candidate(model, *shape, options, tried.family)
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
