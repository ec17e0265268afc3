# SPDX-License-Identifier: GPL-3.0-or-later
"""Search spaces: the cells, lags and options among which the setting of each model is chosen."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import product
from typing import Any

from bedchain.studies.candidates import Candidate, is_resolved
from bedchain.trajectory.grid import Grid


@dataclass(frozen=True)
class SearchSpace:
    """Settings of one model, in every combination.

    Parameters
    ----------
    cells : tuple of float
        Sizes of a cell over that of the case [1].
    lags : tuple of int
        Lags over that of the case [1].
    options : tuple of dict
        Keyword arguments of the model.
    family : str
        Name under which all these compete, where one model has several entries.
    """

    cells: tuple[float, ...] = (0.5, 1, 2)
    lags: tuple[int, ...] = (1, 2, 4, 8)
    options: tuple[dict[str, Any], ...] = field(default=({},))
    family: str = ""


# Classes of the velocity along x and z: none, of both alike, of the height alone.
CLASSES = ({"classes": [1, 1]}, {"classes": [3, 3]}, {"classes": [5, 5]}, {"classes": [1, 5]})
# A model that is not here has the defaults of `SearchSpace`. The dynamic chain needs cells finer than
# a displacement to carry the velocity, and its pairs become too many to learn from at long lags.
# The recurrence chain does not use the cells; its two baselines compete as models of their own.
SEARCH_SPACES: dict[str, tuple[SearchSpace, ...]] = {
    # Finer cells here, and fine cells by many classes, take more than a gigabyte on the paper's bed.
    "dynamic": (SearchSpace((0.5,), (1, 2)), SearchSpace((1,), (1, 2, 4))),
    "velocity_class": (
        SearchSpace((0.5,), (1, 2), CLASSES[1:2]),
        SearchSpace((1, 2), (1, 2, 4), CLASSES[1:]),
    ),
    "jump": (SearchSpace((1, 2), (1, 2, 4), CLASSES),),
    "recurrence": (
        SearchSpace((1,), (2, 4), ({"segment_s": 0.2}, {"segment_s": 0.5}, {"segment_s": 1.0})),
        SearchSpace((1,), (4,), ({"order": "shuffled"},), "recurrence_shuffled"),
        SearchSpace((1,), (4,), ({"order": "replay"},), "recurrence_replay"),
    ),
}


def candidates(models: Iterable[str], case_grid: Grid, case_lag: int, resolution_m: float) -> list[Candidate]:
    """Candidates of all models, with the case's cells and lag among them where a search space holds 1.

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
        Each once.
    """
    by_key: dict[str, Candidate] = {}
    for model in models:
        for space in SEARCH_SPACES.get(model, (SearchSpace(),)):
            for size, lag, options in product(space.cells, space.lags, space.options):
                grid = scaled(case_grid, size)
                if is_resolved(grid, resolution_m):
                    shape = (grid.columns, grid.rows, lag * case_lag)
                    candidate = Candidate(model, *shape, options, space.family)
                    by_key[candidate.key] = candidate
    return list(by_key.values())


def scaled(grid: Grid, size: float) -> Grid:
    """Cells ``size`` times as large on the same bed, as nearly as whole numbers of cells allow."""
    columns, rows = (max(1, round(count / size)) for count in (grid.columns, grid.rows))
    return Grid(grid.width_m, grid.height_m, columns, rows)
