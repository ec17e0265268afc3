# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of the chains at extremes, each for every model that it applies to."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from bedchain.chains import registry
from bedchain.chains.chain import Chain
from bedchain.chains.counting import count_moves
from bedchain.chains.estimators import transition_matrix
from bedchain.chains.markov_chain import MarkovChain
from bedchain.studies.stability.chain_runs import ChainCase, rare_moves, run_chain
from bedchain.studies.stability.settings import ON, Known, StabilitySetting
from bedchain.studies.stability.theory import Limit
from bedchain.studies.stability.verdict import Verdict
from bedchain.studies.stability.walkers import (
    DIAMETER,
    HEIGHT,
    WIDTH,
    lifted,
    lifted_last,
    on_grid,
    repeated,
    walkers,
    with_drain,
)
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid

FRAMES, PARTICLES = 41, 400
HISTORY = {"dynamic": 2}  # lags between the first and last frame of a move; 1 for the other models
STEPS = {"static": 10**6, "dynamic": 10**6, "velocity_class": 10**6, "jump": 10**5, "recurrence": 10**4}
MANY, SOME = 10**7, 10**5  # tracers in the full and in the reduced set
PROBABILITIES = (1e-12, 1e-100, 1e-300)
SMALLEST = 2.2e-308  # of a normal double
RECURRENCE = {"separation_s": 0.1, "segment_s": 0.2, "coarse_m": 0.01}  # for windows of a second
Build = Callable[[], ChainCase]
Learn = Callable[..., Chain]


@dataclass(frozen=True)
class WalkerWindow:
    """A window of synthetic frames, a grid, and the run of a chain that starts at the end of the window.

    Attributes
    ----------
    columns, rows : int
        Cells.
    n_frames, n_particles : int
    lag, steps : int
        Frames in a step, steps of the run.
    change : callable, optional
        Applied to the frames.
    top : float
        Share of the height that the particles use [1].
    copies : int
        Copies of each particle at the start.
    lift : float
        Share of the particles moved to the top at the start [1].
    settled, options
        As in `ChainCase`.
    """

    columns: int = 4
    rows: int = 6
    n_frames: int = FRAMES
    n_particles: int = PARTICLES
    lag: int = 1
    steps: int = 40
    change: Callable[[Frames], Frames] | None = None
    top: float = 1.0
    copies: int = 1
    lift: float = 0.0
    settled: bool = False
    options: dict[str, Any] = field(default_factory=dict)

    def case(self) -> ChainCase:
        """Frames, grid and start, the last frames of the window."""
        grid = Grid(WIDTH, HEIGHT, self.columns, self.rows)
        frames = walkers(self.n_frames, self.n_particles, top=self.top)
        frames = on_grid(self.change(frames) if self.change else frames, grid)
        start = frames.part(slice(-min(self.n_frames, self.lag + 1), None))
        if self.lift:
            start = on_grid(lifted(start, self.lift), grid)
        if self.copies > 1:
            start = repeated(start, self.copies)
        return ChainCase(frames, grid, start, self.lag, self.steps, self.settled, self.options)


def no_limit() -> Limit:
    """No limit by theory."""
    return Limit("none", float("inf"), "mass and probabilities hold for any", float("nan"))


def window_limit(model: str, n_frames: int, lag: int) -> Limit:
    """Longest lag of a model in a window."""
    history = HISTORY.get(model, 1)
    return Limit("lag [frames]", (n_frames - 1) // history, f"(frames - 1) / {history}", lag)


def setting_of(
    group: str, name: str, model: str, limit: Limit, keys: dict[str, Any], reduced: bool = True,
    guards: str = ON, learn: Learn | None = None,
) -> StabilitySetting:  # fmt: skip
    """Setting of a model on a `WalkerWindow` with the given keys."""
    if model == "recurrence":
        keys = keys | {"options": RECURRENCE}
    window = WalkerWindow(**keys)
    values: dict[str, float | str] = {
        "model": model, "columns_1": window.columns, "rows_1": window.rows, "frames_1": window.n_frames,
        "lag_frames_1": window.lag, "steps_1": window.steps, "tracers_1": window.n_particles * window.copies,
    }  # fmt: skip
    words = {key: getattr(value, "__name__", value) for key, value in keys.items()}
    full = f"{name}, {model}{'' if guards == ON else ', guard off'}"
    run = partial(_run, model, window.case, learn or registry.learn)
    inputs = repr((sorted(words.items()), guards))
    return StabilitySetting(group, full, values, limit, run, inputs, guards, "", reduced)


def _run(model: str, build: Build, learn: Learn, folder: Path, known: Known) -> Verdict:
    return run_chain(model, build, learn)


def chain_settings() -> list[StabilitySetting]:
    """All settings of the chains, group by group."""
    groups = (grids, windows, sizes, long_runs, probabilities, traps)
    return [setting for group in groups for setting in group()]


def grids() -> Iterator[StabilitySetting]:
    """Grids: a single cell, cells of a diameter, a single row or column, unvisited cells, a drain."""
    per_diameter = {"columns": round(WIDTH / DIAMETER), "rows": round(HEIGHT / DIAMETER)}
    settings: dict[str, dict[str, Any]] = {
        "1 x 1 cell": {"columns": 1, "rows": 1, "settled": True},
        "one cell a diameter": per_diameter,
        "a row of one": {"columns": 1, "settled": True},
        "a column of one": {"rows": 1, "settled": True},
        "unvisited cells": {"top": 0.5, "lift": 0.1},
        "absorbing cell": {"change": with_drain},
    }
    for name, keys in settings.items():
        for model in registry.LEARNERS:
            yield setting_of("chain grid", name, model, no_limit(), keys)


def windows() -> Iterator[StabilitySetting]:
    """Lags from one frame to more than half the window, a window of two frames."""
    for lag in (1, (FRAMES - 1) // 4, (FRAMES - 1) // 2, FRAMES - 2):
        for model in registry.LEARNERS:
            limit = window_limit(model, FRAMES, lag)
            yield setting_of(
                "chain window", f"lag of {lag} of {FRAMES - 1} frames", model, limit, {"lag": lag}
            )
    for model in registry.LEARNERS:
        keys = {"n_frames": 2}
        yield setting_of("chain window", "window of two frames", model, window_limit(model, 2, 1), keys)


def sizes() -> Iterator[StabilitySetting]:
    """One particle, and ten million tracers."""
    for model in registry.LEARNERS:
        yield setting_of("chain size", "one particle", model, no_limit(), {"n_particles": 1})
    for tracers in (SOME, MANY):
        for model in registry.LEARNERS:
            limit = Limit("standard error of half [1]", 0.005, "1 / (2 sqrt(n))", 0.5 * tracers**-0.5)
            keys = {"copies": tracers // PARTICLES, "steps": 3}
            yield setting_of("chain size", f"{tracers:.0e} tracers", model, limit, keys, tracers == SOME)


def long_runs() -> Iterator[StabilitySetting]:
    """Runs of up to a million steps."""
    for model in registry.LEARNERS:
        steps = STEPS[model]
        limit = Limit("steps [1]", 1e-9 / np.finfo(float).eps, "1e-9 / eps, were mass not renewed", steps)
        keys = {"columns": 2, "rows": 3, "steps": steps, "n_particles": 100}
        yield setting_of("chain steps", f"{steps:.0e} steps", model, limit, keys, False)


def probabilities() -> Iterator[StabilitySetting]:
    """Moves of a tiny probability."""
    for probability in PROBABILITIES:
        limit = Limit("1 over probability [1]", 1 / SMALLEST, "1 / 2.2e-308, normal doubles", 1 / probability)
        values: dict[str, float | str] = {
            "model": "static", "columns_1": 3, "rows_1": 1, "steps_1": 100, "tracers_1": 1000,
            "probability_1": probability,
        }  # fmt: skip
        run = partial(_run_rare, probability)
        name = f"probability of {probability:.0e}"
        yield StabilitySetting("chain probability", name, values, limit, run, repr(probability), reduced=True)


def _run_rare(probability: float, folder: Path, known: Known) -> Verdict:
    return rare_moves(probability, 100, 1000)


def traps() -> Iterator[StabilitySetting]:
    """A cell entered in the last frame only: a trap, unless the estimator opens closed classes."""
    keys = {"top": 0.5, "change": lifted_last, "settled": True}
    for model in registry.LEARNERS:
        yield setting_of("chain trap", "cell entered in the last frame", model, no_limit(), keys)
    yield setting_of(
        "chain trap", "cell entered in the last frame", "static", no_limit(), keys,
        guards="estimators.open_classes", learn=learn_shut,
    )  # fmt: skip


def learn_shut(name: str, frames: Frames, grid: Grid, lag: int = 1) -> MarkovChain:
    """The static chain straight from its counts, whose closed classes stay closed."""
    counts = count_moves(frames.cells, grid.n_cells, lag)
    chain = registry.learn(name, frames, grid, lag)
    assert isinstance(chain, MarkovChain)
    return replace(chain, matrix=transition_matrix(counts, "pooled", open_closed=False))
