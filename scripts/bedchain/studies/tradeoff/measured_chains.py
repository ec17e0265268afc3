# SPDX-License-Identifier: GPL-3.0-or-later
"""Learn and run chains of many settings, and measure cost and errors of each."""

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
from bedchain.studies.records import record_of
from bedchain.studies.scan import Task, at_frames, learned, observed_curves, scan, timed
from bedchain.studies.scores.candidates import Candidate, grid_of
from bedchain.studies.scores.marked_starts import Start, split, starts_in
from bedchain.studies.scores.tested_chain import batch_shares
from bedchain.studies.tradeoff.chain_settings import Own, Setting, settings
from bedchain.studies.tradeoff.observables import (
    INTERVAL_SEED,
    REPLICATES,
    Reference,
    curve_errors,
    density_errors,
)
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import Realisation
from bedchain.trajectory.regrid import regrid
from bedchain.uncertainty.deviations import interval, resampled, rms, stacked

LOG = logging.getLogger(__name__)

Array = NDArray[np.float64]
Row = dict[str, Any]

HALF = "mcm"
# the mean density of a chain is that at so many moments of each half of the comparison window
MOMENTS = 10
# a Monte Carlo of few tracers is drawn so often, lest its error hang on one draw; one of many takes long
DRAWS, FEW_TRACERS = 8, 10_000
MB = 1e6
# lags that lead up to a start: as far as a chain of the second order looks back
LAGS_BACK = 1


@dataclass(frozen=True)
class Fold:
    """Parts of the learning window to learn from and to judge on.

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
        """Frames that a chain may look back and ahead in any start [1]."""
        return min(self.fit.stop - 1 - self.fit.start, *(start.length for start in self.starts))


@dataclass(frozen=True)
class Bench:
    """What all settings share.

    Parameters
    ----------
    run : Realisation
        The run learned from.
    own : Own
        The case's own chain.
    task : Task
    reference : Reference
        Its curves are of `starts`.
    folds : tuple of Fold
    starts : tuple of Start
        Of the run: one for all curves of the reference, or one for each of them.
    seed : int
        Of the Monte Carlo runs.
    """

    run: Realisation
    own: Own
    task: Task
    reference: Reference
    folds: tuple[Fold, ...]
    starts: tuple[Start, ...]
    seed: int


def measure_all(bench: Bench, kept: Path) -> list[Row]:
    """Rows of all settings, those kept from an earlier try first.

    Parameters
    ----------
    bench : Bench
    kept : Path
        Folder of results that are taken up again after a stop; its name stands for data and code.

    Returns
    -------
    list of dict
        One a setting: `labels`, cost, errors, ``problem`` (empty where all went well).
    """
    tried = settings(bench.own)
    if any(not record_of(kept, setting.key).exists() for setting in tried):
        warm_up(bench)
    in_memory = lru_cache(maxsize=1)(lambda grid: bench.run.frames(grid, bench.own.learning))
    results = scan(
        tried,
        lambda setting: tested(setting, bench, in_memory),
        lambda setting: setting.key,
        lambda result: result["problem"] or f"rms error {result['mixing_error_1']:.4f}",
        kept,
    )
    return [labels(setting, bench) | result for setting, result in zip(tried, results, strict=True)]


def tested(setting: Setting, bench: Bench, in_memory: Callable[[Grid], Frames]) -> Row:
    """Cost and errors of a setting, or the problem that it has with these data."""
    try:
        return measured(setting, bench, in_memory(grid_of(setting.candidate, bench.own.grid)))
    except DataError as problem:
        return {"problem": str(problem)}


def warm_up(bench: Bench) -> None:
    """Have each model's code compiled, which takes seconds, before anything is timed."""
    own = bench.own
    frames = bench.run.frames(own.grid, slice(own.learning.start, own.learning.start + 2 * own.lag + 2))
    for model in own.models:
        one = Candidate(model, own.grid.columns, own.grid.rows, own.lag)
        chain = learned(one, frames, bench.task)
        predicted(chain, bench, bench.starts[0], own.lag)
        predicted(chain, bench, bench.starts[0], own.lag, np.random.default_rng(bench.seed), tracers=2)


def labels(setting: Setting, bench: Bench) -> Row:
    """The columns that say which setting a row is of."""
    grid, times = grid_of(setting.candidate, bench.own.grid), bench.run.times_s
    return {
        "half": HALF, "axis": setting.axis, "variant": setting.key, "model": setting.model,
        "estimator": setting.estimator, "cell_width_m": grid.cell_width_m,
        "cell_height_m": grid.cell_height_m, "lag_s": setting.lag * bench.own.interval_s,
        "learning_start_s": float(times[setting.first]), "learning_end_s": float(times[setting.last]),
        "tracers": setting.tracers,
    }  # fmt: skip


def measured(setting: Setting, bench: Bench, frames: Frames) -> Row:
    """Cost and errors of one setting.

    Parameters
    ----------
    setting : Setting
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
    first = bench.own.learning.start
    part = frames.part(slice(setting.first - first, setting.last - first + 1))
    chain, learn_s = timed(lambda: learned(setting.candidate, part, task))
    size = sum(array.nbytes for array in chain.arrays().values())
    cost = {"learn_s": learn_s, "memory_mb": size / MB}
    runs = [_drawn(chain, bench, setting, draw) for draw in range(_draws(setting))]
    result = cost | {"run_s": min(run_s for *_, run_s in runs)}
    result["cost_s"] = result["learn_s"] + result["run_s"]
    result |= curve_errors(bench.reference, np.stack([curves for curves, *_ in runs]))
    result |= density_errors(bench.reference, np.stack([density for _, density, _ in runs]))
    return result | validated(setting, bench, frames) | {"problem": ""}


def validated(setting: Setting, bench: Bench, frames: Frames) -> Row:
    """Error in parts of the learning window of chains learned on the rest of it.

    Learned on the first 70 % and judged on the last 30 %, and the other way round: one part of a short window
    holds few bubbles.

    Returns
    -------
    dict
        validation_error_1, validation_ci_low_1, validation_ci_high_1; empty for a chain of part of the
        window, for a Monte Carlo, and where the lag is too long.
    """
    learning, lag = bench.own.learning, setting.lag
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
    table = stacked(error)
    weights = resampled(np.zeros(len(table), np.int64), REPLICATES, np.random.default_rng(INTERVAL_SEED))
    low, high = interval(rms, table, weights)
    names = ("validation_error_1", "validation_ci_low_1", "validation_ci_high_1")
    return dict(zip(names, (float(rms(table)), low, high), strict=True))


def folds(run: Realisation, learning: slice, task: Task) -> tuple[Fold, ...]:
    """The two of `marked_starts.split`: the window's last part judged, and as long a first part.

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
    made = []
    for part, judged in ((fit, rest), (slice(cut, learning.stop), slice(learning.start, cut + 1))):
        starts = tuple(starts_in(judged, task.spacing))
        made.append(Fold(part, starts, tuple(observed_curves(run, one, task.splits)[1:] for one in starts)))
    return tuple(made)


def predicted(
    chain: Chain, bench: Bench, start: Start, lag: int, rng: np.random.Generator | None = None,
    tracers: int = 0,
) -> Array:  # fmt: skip
    """Mixing curves at every frame from a start, (length + 1, 4); with an ``rng`` of so many tracers."""
    begin = _begin(chain.grid, bench, start, lag, rng, tracers)
    curves = chain.mixing(begin, *bench.task.splits, -(-start.length // lag), rng)
    return at_frames(curves, lag, start.length)


def half_moments(length: int) -> NDArray[np.int64]:
    """Rising frames after the start at which densities stand for the halves of a window, (2, `MOMENTS`)."""
    edges = np.array([0, length // 2, length])
    ends = [np.linspace(low, high, MOMENTS + 1)[1:] for low, high in zip(edges, edges[1:], strict=False)]
    return np.maximum(np.round(ends), 1).astype(np.int64)


def _drawn(chain: Chain, bench: Bench, setting: Setting, draw: int) -> tuple[Array, Array, float]:
    """Curves of all starts, mean densities of both halves on the case's cells, and the time of the first."""
    start, lag, tracers = bench.starts[0], setting.lag, setting.tracers

    def rng() -> np.random.Generator | None:
        return np.random.default_rng([bench.seed, draw]) if tracers else None

    begin = _begin(chain.grid, bench, start, lag, rng(), tracers)
    steps = -(-start.length // lag)
    made, run_s = timed(lambda: chain.mixing(begin, *bench.task.splits, steps, rng()))
    others = [predicted(chain, bench, one, lag, rng(), tracers)[1:] for one in bench.starts[1:]]
    curves = stacked([at_frames(made, lag, start.length)[1:], *others])
    everyone = np.ones(begin.cells.shape[1], bool)
    moments = half_moments(start.length)
    every = np.unique(moments)
    shares = batch_shares(chain, begin, everyone, every, lag, rng())
    halves = np.stack([shares[np.searchsorted(every, half)].mean(axis=0) for half in moments])
    return curves, regrid(halves, chain.grid, bench.own.grid), run_s


def _begin(
    grid: Grid, bench: Bench, start: Start, lag: int, rng: np.random.Generator | None, tracers: int
) -> Frames:
    """Frames up to a start, as far back as a chain of the second order looks; of drawn particles."""
    found = bench.run.leading_to(grid, start.frame, lag, LAGS_BACK)
    if rng is None:
        return found
    number = found.cells.shape[1]
    chosen = rng.choice(number, tracers, replace=tracers > number)
    return Frames(found.times_s, found.x_m[:, chosen], found.z_m[:, chosen], found.cells[:, chosen])


def _draws(setting: Setting) -> int:
    return DRAWS if 0 < setting.tracers <= FEW_TRACERS else 1
