# SPDX-License-Identifier: GPL-3.0-or-later
"""Cost and errors of the chains of the trade-off, each learned and run."""

import logging
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bedchain.chains.chain import Chain
from bedchain.errors import DataError
from bedchain.meter import BYTES_IN_MB
from bedchain.studies.candidates import Candidate, grid_of
from bedchain.studies.marked_starts import Start, split, starts_in
from bedchain.studies.records import record_of
from bedchain.studies.scan import Task, at_frames, learned, observed_curves, rms_over_starts, scan, timed
from bedchain.studies.scores.predictions import batch_shares
from bedchain.studies.tradeoff.chain_settings import CaseChain, ChainSetting, chain_settings
from bedchain.studies.tradeoff.observables import (
    INTERVAL_SEED,
    Reference,
    curve_errors,
    density_errors,
)
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import Realisation
from bedchain.trajectory.regrid import regrid
from bedchain.uncertainty.deviations import stacked

LOG = logging.getLogger(__name__)

Array = NDArray[np.float64]
Row = dict[str, Any]

HALF = "mcm"
# moments in each half of the comparison window over which the density is averaged
MOMENTS = 10
# draws of a Monte Carlo of up to `FEW_TRACERS`, whose error depends on the draw; of more tracers a single one
DRAWS, FEW_TRACERS = 8, 10_000
# lags that lead up to a start: as far as a chain of the second order looks back
LAGS_BACK = 1


@dataclass(frozen=True)
class Fold:
    """A part of the learning window to learn from, and starts in the other part.

    Parameters
    ----------
    fit : slice
        Frames of the run.
    starts : tuple of Start
        In the other part.
    observed : tuple of (length, 4) array
        The run's mixing curves from each start, from the next frame on [1].
    """

    fit: slice
    starts: tuple[Start, ...]
    observed: tuple[Array, ...]

    @property
    def longest(self) -> int:
        """Longest reach of a chain, back in the fit and ahead from any start [frames]."""
        return min(self.fit.stop - 1 - self.fit.start, *(start.length for start in self.starts))


@dataclass(frozen=True)
class Bench:
    """Data and settings that all chains share.

    Parameters
    ----------
    run : Realisation
        The run learned from.
    base : CaseChain
        The chain of the case.
    task : Task
    reference : Reference
        With curves of `starts`.
    folds : tuple of Fold
    starts : tuple of Start
        Of the run: a single one for all curves of the reference, or one for each curve.
    seed : int
        Of the Monte Carlo runs.
    """

    run: Realisation
    base: CaseChain
    task: Task
    reference: Reference
    folds: tuple[Fold, ...]
    starts: tuple[Start, ...]
    seed: int


def measure_all(bench: Bench, kept: Path) -> list[Row]:
    """Rows of all settings, from records where they are there.

    Parameters
    ----------
    bench : Bench
    kept : Path
        Folder of records that a stopped study goes on from; its name stands for data and code.

    Returns
    -------
    list of dict
        One for each setting: `labels`, cost, errors, ``problem`` (empty without one).
    """
    settings = chain_settings(bench.base)
    if any(not record_of(kept, setting.key).exists() for setting in settings):
        warm_up(bench)
    in_memory = lru_cache(maxsize=1)(lambda grid: bench.run.frames(grid, bench.base.learning))
    results = scan(
        settings,
        lambda setting: tested(setting, bench, in_memory),
        lambda setting: setting.key,
        lambda result: result["problem"] or f"rms error {result['mixing_error_1']:.4f}",
        kept,
    )
    return [labels(setting, bench) | result for setting, result in zip(settings, results, strict=True)]


def tested(setting: ChainSetting, bench: Bench, in_memory: Callable[[Grid], Frames]) -> Row:
    """Cost and errors of a setting, or the reason why the data do not serve it."""
    try:
        return measured(setting, bench, in_memory(grid_of(setting.candidate, bench.base.grid)))
    except DataError as problem:
        return {"problem": str(problem)}


def warm_up(bench: Bench) -> None:
    """Run each model once, since compiling its code takes seconds, before anything is timed."""
    base = bench.base
    frames = bench.run.frames(base.grid, slice(base.learning.start, base.learning.start + 2 * base.lag + 2))
    for model in base.models:
        candidate = Candidate(model, base.grid.columns, base.grid.rows, base.lag)
        chain = learned(candidate, frames, bench.task)
        predicted(chain, bench, bench.starts[0], base.lag)
        predicted(chain, bench, bench.starts[0], base.lag, np.random.default_rng(bench.seed), tracers=2)


def labels(setting: ChainSetting, bench: Bench) -> Row:
    """Columns that identify the setting of a row."""
    grid, times = grid_of(setting.candidate, bench.base.grid), bench.run.times_s
    return {
        "half": HALF, "axis": setting.axis, "variant": setting.key, "model": setting.model,
        "estimator": setting.estimator, "cell_width_m": grid.cell_width_m,
        "cell_height_m": grid.cell_height_m, "lag_s": setting.lag * bench.base.interval_s,
        "learning_start_s": float(times[setting.first]), "learning_end_s": float(times[setting.last]),
        "tracers": setting.tracers,
    }  # fmt: skip


def measured(setting: ChainSetting, bench: Bench, frames: Frames) -> Row:
    """Cost and errors of one setting.

    Parameters
    ----------
    setting : ChainSetting
    bench : Bench
    frames : Frames
        The case's whole learning window on the setting's cells.

    Returns
    -------
    dict
        Cost, errors of validation and test, and ``problem``.

    Raises
    ------
    DataError
        The model cannot use the data.
    """
    task = replace(bench.task, estimator=setting.estimator)
    first = bench.base.learning.start
    part = frames.part(slice(setting.first - first, setting.last - first + 1))
    chain, learn_s = timed(lambda: learned(setting.candidate, part, task))
    size = sum(array.nbytes for array in chain.arrays().values())
    cost = {"learn_s": learn_s, "memory_mb": size / BYTES_IN_MB}
    runs = [_drawn(chain, bench, setting, draw) for draw in range(_draws(setting))]
    result = cost | {"run_s": min(run_s for *_, run_s in runs)}
    result["cost_s"] = result["learn_s"] + result["run_s"]
    result |= curve_errors(bench.reference, np.stack([curves for curves, *_ in runs]))
    result |= density_errors(bench.reference, np.stack([density for _, density, _ in runs]))
    return result | validated(setting, bench, frames) | {"problem": ""}


def validated(setting: ChainSetting, bench: Bench, frames: Frames) -> Row:
    """Validation error: of chains learned on one part of the learning window, in the other part.

    Two folds, learned on the first or the last 70 % and judged on the rest, since a part of a short window
    holds few bubbles.

    Returns
    -------
    dict
        validation_error_1, validation_ci_low_1, validation_ci_high_1; empty for a chain of part of the
        window, for a Monte Carlo, and where the lag is too long.
    """
    learning, lag = bench.base.learning, setting.lag
    whole = (setting.first, setting.last) == (learning.start, learning.stop - 1)
    reach = lag * (2 if setting.model == "dynamic" else 1)
    if setting.tracers or not whole or reach > min(fold.longest for fold in bench.folds):
        return {}
    task = replace(bench.task, estimator=setting.estimator)
    error = []
    for fold in bench.folds:
        part = frames.part(slice(fold.fit.start - learning.start, fold.fit.stop - learning.start))
        chain = learned(setting.candidate, part, task)
        error += [
            predicted(chain, bench, start, lag)[1:] - observed
            for start, observed in zip(fold.starts, fold.observed, strict=True)
        ]
    names = ("validation_error_1", "validation_ci_low_1", "validation_ci_high_1")
    return dict(zip(names, rms_over_starts(error, INTERVAL_SEED), strict=True))


def folds(run: Realisation, learning: slice, task: Task) -> tuple[Fold, ...]:
    """Two folds: the last part of the window judged (`marked_starts.split`), and a first part as long.

    Parameters
    ----------
    run : Realisation
    learning : slice
        Frames of the learning window.
    task : Task

    Raises
    ------
    UserError
        The window is too short.
    """
    fit, rest = split(learning)
    cut = learning.start + rest.stop - 1 - rest.start
    both = []
    for part, judged in ((fit, rest), (slice(cut, learning.stop), slice(learning.start, cut + 1))):
        starts = tuple(starts_in(judged, task.spacing))
        curves = tuple(observed_curves(run, start, task.splits)[1:] for start in starts)
        both.append(Fold(part, starts, curves))
    return tuple(both)


def predicted(
    chain: Chain, bench: Bench, start: Start, lag: int, rng: np.random.Generator | None = None,
    tracers: int = 0,
) -> Array:  # fmt: skip
    """Mixing curves at every frame from a start, (length + 1, 4); with an ``rng`` from that many tracers."""
    begin = _begin(chain.grid, bench, start, lag, rng, tracers)
    curves = chain.mixing(begin, *bench.task.splits, -(-start.length // lag), rng)
    return at_frames(curves, lag, start.length)


def half_moments(length: int) -> NDArray[np.int64]:
    """Frames after the start at which densities of each half of a window are averaged, (2, `MOMENTS`)."""
    edges = np.array([0, length // 2, length])
    ends = [np.linspace(low, high, MOMENTS + 1)[1:] for low, high in zip(edges, edges[1:], strict=False)]
    return np.maximum(np.round(ends), 1).astype(np.int64)


def _drawn(chain: Chain, bench: Bench, setting: ChainSetting, draw: int) -> tuple[Array, Array, float]:
    """Curves of all starts, mean densities of both halves on the case's cells, time of one curve [s]."""
    start, lag, tracers = bench.starts[0], setting.lag, setting.tracers

    def rng() -> np.random.Generator | None:
        return np.random.default_rng([bench.seed, draw]) if tracers else None

    begin = _begin(chain.grid, bench, start, lag, rng(), tracers)
    steps = -(-start.length // lag)
    first, run_s = timed(lambda: chain.mixing(begin, *bench.task.splits, steps, rng()))
    others = [predicted(chain, bench, start, lag, rng(), tracers)[1:] for start in bench.starts[1:]]
    curves = stacked([at_frames(first, lag, start.length)[1:], *others])
    everyone = np.ones(begin.cells.shape[1], bool)
    moments = half_moments(start.length)
    every = np.unique(moments)
    shares = batch_shares(chain, begin, everyone, every, lag, rng())
    halves = np.stack([shares[np.searchsorted(every, half)].mean(axis=0) for half in moments])
    return curves, regrid(halves, chain.grid, bench.base.grid), run_s


def _begin(
    grid: Grid, bench: Bench, start: Start, lag: int, rng: np.random.Generator | None, tracers: int
) -> Frames:
    """Frames up to a start, as far back as a second-order chain looks; with an ``rng`` of drawn particles."""
    frames = bench.run.leading_to(grid, start.frame, lag, LAGS_BACK)
    if rng is None:
        return frames
    number = frames.cells.shape[1]
    chosen = rng.choice(number, tracers, replace=tracers > number)
    return Frames(frames.times_s, frames.x_m[:, chosen], frames.z_m[:, chosen], frames.cells[:, chosen])


def _draws(setting: ChainSetting) -> int:
    return DRAWS if 0 < setting.tracers <= FEW_TRACERS else 1
