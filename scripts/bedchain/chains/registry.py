# SPDX-License-Identifier: GPL-3.0-or-later
"""Models by name: functions that learn, save and load chains.

A model is a name in `LEARNERS` and `READERS`. Models that are Markov on a set of states (cells, pairs of
cells, cells by velocity class) are a `MarkovChain`; a model may be any other class with the methods of
`Chain`. Scripts loop over names and know no particular model.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bedchain.array_files import read_arrays
from bedchain.case.cell_checks import not_flat
from bedchain.chains import dynamic, jump, recurrence, static, velocity_class
from bedchain.chains.between_steps import Fractions
from bedchain.chains.chain import Chain
from bedchain.chains.markov_chain import MarkovChain
from bedchain.errors import DataError, make_again
from bedchain.files import write_arrays
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid
from bedchain.uncertainty.bands import kept_steps

# Each takes frames, a grid and the keyword arguments of `learn`.
LEARNERS: dict[str, Callable[..., Chain]] = {
    "static": static.learn,
    "dynamic": dynamic.learn,
    "velocity_class": velocity_class.learn,
    "jump": jump.learn,
    "recurrence": recurrence.learn,
}
READERS: dict[str, Callable[[dict[str, NDArray[Any]]], Chain]] = {
    "static": MarkovChain.from_arrays,
    "dynamic": MarkovChain.from_arrays,
    "velocity_class": MarkovChain.from_arrays,
    "jump": jump.JumpChain.from_arrays,
    "recurrence": recurrence.RecurrenceChain.from_arrays,
    "chosen": MarkovChain.from_arrays,
}
# Models that follow each particle through the window.
WHOLE = {"jump", "recurrence"}

# For models that count once and learn faster without some blocks of the window.
RELEARNERS: dict[str, Callable[..., Callable[[NDArray[np.bool_]], Chain]]] = {
    "static": static.relearner,
    "dynamic": dynamic.relearner,
    "velocity_class": velocity_class.relearner,
    "recurrence": recurrence.relearner,
}

# The static chain with the lag and the cells of choice.csv, beside those of the case: learned as its model.
CHOSEN = "chosen"
LEARNED_AS = {CHOSEN: "static"}


@dataclass(frozen=True)
class ModelSettings:
    """Settings of a case's chains besides their grid and lag.

    Attributes
    ----------
    estimator : {"literal", "per_step", "pooled"}
        How counts become probabilities.
    seed : int
        Of blocks and of Monte Carlo runs.
    options : dict
        Settings of a model only; where there are several models, by their names.
    """

    estimator: str
    seed: int
    options: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class CaseChains:
    """The case's own chains.

    Attributes
    ----------
    columns, rows : int
        Of their grid.
    lag_s : float
        Of a step [s].
    estimator : {"literal", "per_step", "pooled"}
        How counts become probabilities.
    layers, form, outside
        Of the cells, and whether particles may leave: see `not_flat`.
    """

    columns: int
    rows: int
    lag_s: float
    estimator: str
    layers: int = field(default=1, kw_only=True)
    form: str = field(default="boxes", kw_only=True)
    outside: str = field(default="refuse", kw_only=True)

    def flat_grid(self, width_m: float, height_m: float) -> Grid:
        """The cells over a bed of this size.

        Raises
        ------
        DataError
            They are no flat boxes, or particles may leave the bed.
        """
        if reason := not_flat(self.form, self.layers, self.outside):
            raise DataError(f"{reason}: take a case of its own for these studies")
        return Grid(width_m, height_m, self.columns, self.rows)


def learn(
    name: str,
    frames: Frames,
    grid: Grid,
    lag: int = 1,
    estimator: str = "pooled",
    step_weights: NDArray[np.int64] | None = None,
    **options: Any,
) -> Chain:
    """Learn a chain from a window of frames.

    Parameters
    ----------
    name : str
        A name in `LEARNERS`.
    frames : Frames
        The learning window.
    grid : Grid
        The cells that ``frames.cells`` refers to.
    lag : int
        Frames in a step.
    estimator : {"literal", "per_step", "pooled"}
        How counts become probabilities.
    step_weights : (n_frames - lag,) int array, optional
        How many times the step starting at each frame counts (bootstrap); 1 by default.
    **options
        Settings of this model.

    Returns
    -------
    Chain

    Raises
    ------
    DataError
        The name is unknown, or the data cannot be used.
    """
    model = LEARNED_AS.get(name, name)
    if model not in LEARNERS:
        raise DataError(f"model {name!r} is unknown: choose from {', '.join(LEARNERS)}")
    if model in WHOLE and any((now < 0).any() for now in frames.cells):
        raise DataError(
            f"particles come and go in the learning window, which the {name} chain cannot learn from: take "
            f"{', '.join(sorted(LEARNERS.keys() - WHOLE))}"
        )
    chain = LEARNERS[model](frames, grid, lag=lag, estimator=estimator, step_weights=step_weights, **options)
    return replace(chain, name=name) if isinstance(chain, MarkovChain) else chain


def relearner(
    name: str, frames: Frames, grid: Grid, lag: int = 1, estimator: str = "pooled", **options: Any
) -> Callable[[NDArray[np.bool_]], Chain]:
    """`learn` without some of the `bands.BLOCKS` equal blocks of the window; arguments as `learn`.

    Models in `RELEARNERS` count once, block by block.

    Returns
    -------
    callable
        From the blocks that are kept, (BLOCKS,) bool such as a row of `bands.kept_blocks`, to a `Chain`. A
        step belongs to the block that it starts in.
    """
    name = LEARNED_AS.get(name, name)
    if name in RELEARNERS:
        return RELEARNERS[name](frames, grid, lag=lag, estimator=estimator, **options)
    n_steps = len(frames.times_s) - lag
    return lambda kept: learn(name, frames, grid, lag, estimator, kept_steps(kept, n_steps), **options)


def save(chain: Chain, path: Path | str, fractions: Fractions | None = None) -> None:
    """Write a chain for `load`, and its fractions of a step; the file is complete or not there."""
    of_step = {} if fractions is None else fractions.arrays()
    write_arrays(path, {"name": np.array(chain.name), **chain.arrays(), **of_step})


def load_fractions(path: Path | str) -> Fractions:
    """Matrices for fractions of a step, written by `save` beside a chain."""
    return Fractions.from_arrays(read_arrays(path))


def load(path: Path | str) -> Chain:
    """Chain written by `save`.

    Raises
    ------
    DataError
        The file holds no chain of a known model.
    """
    arrays = read_arrays(path)
    name = str(arrays.pop("name", ""))
    if name not in READERS:
        raise DataError(f"{path} holds no chain of a known model ({name!r}); {make_again(path)}")
    try:
        arrays["name"] = np.array(name)
        return READERS[name](arrays)
    except (ValueError, TypeError, KeyError, IndexError, OverflowError, RecursionError) as error:
        raise DataError(f"{path} holds no whole chain ({error}); {make_again(path)}") from error
