# SPDX-License-Identifier: GPL-3.0-or-later
"""Candidates: a model with its cells, its lag and its options."""

import json
from dataclasses import dataclass, field
from typing import Any

from bedchain.errors import DataError
from bedchain.trajectory.grid import Grid


@dataclass(frozen=True)
class Candidate:
    """A model with one value of each of its settings.

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
        Name under which it competes, where one model has several entries; the model by default.
    """

    model: str
    columns: int
    rows: int
    lag: int
    options: dict[str, Any] = field(default_factory=dict)
    family: str = ""

    @property
    def name(self) -> str:
        """Name under which it competes: one candidate of each name is chosen."""
        return self.family or self.model

    @property
    def options_text(self) -> str:
        """The options as in tables; empty where there are none."""
        return json.dumps(self.options, sort_keys=True) if self.options else ""

    @property
    def key(self) -> str:
        """The candidate in one line, the same for the same settings."""
        return f"{self.name} {self.columns}x{self.rows} lag {self.lag} {self.options_text}".strip()


def grid_of(candidate: Candidate, case_grid: Grid) -> Grid:
    """The cells of a candidate on the bed of the case."""
    return Grid(case_grid.width_m, case_grid.height_m, candidate.columns, candidate.rows)


def is_resolved(grid: Grid, diameter_m: float) -> bool:
    """Whether no cell of a grid is smaller than a particle (`Grid.check_resolution`)."""
    try:
        grid.check_resolution(diameter_m)
    except DataError:
        return False
    return True
