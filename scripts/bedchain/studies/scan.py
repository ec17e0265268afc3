# SPDX-License-Identifier: GPL-3.0-or-later
"""Scan of chains over cells, lags and options: learning, mixing curves and cost of each, with progress.

Discussion, scores and trade-off each scan their settings with their measure of error.
"""

import logging
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from bedchain.chains import registry
from bedchain.chains.between_steps import Fractions, mixing_by_frame
from bedchain.chains.chain import Chain
from bedchain.chains.fraction_shares import ShareFractions
from bedchain.measures.mixing import Splits, remaining_from_positions
from bedchain.studies.candidates import Candidate, grid_of
from bedchain.studies.marked_starts import Start
from bedchain.studies.records import record_of, remembered
from bedchain.trajectory.frames import Frames, lag_frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import Realisation
from bedchain.uncertainty.deviations import interval, resampled, rms, stacked

LOG = logging.getLogger(__name__)
Setting = TypeVar("Setting")
Result = TypeVar("Result")
Value = TypeVar("Value")

# a kernel is timed `REPEATS` times, or fewer once `ENOUGH_S` have passed; the least time counts, since the
# first may include loading compiled code, about a second
REPEATS, ENOUGH_S = 4, 2.0
# of the paths that are timed
PATHS_SEED = 17
# samples of an interval
REPLICATES = 1000


@dataclass(frozen=True)
class Task:
    """Data and settings that all candidates share.

    Parameters
    ----------
    grid : Grid
        The case's cells.
    splits : Splits
    estimator : str
        How counts become probabilities.
    spacing : int
        Frames between starts.
    comparison : int
        Frame intervals in the comparison window, the length of a run that is timed.
    """

    grid: Grid
    splits: Splits
    estimator: str
    spacing: int
    comparison: int


def scan(
    settings: Sequence[Setting],
    measure: Callable[[Setting], Result],
    name: Callable[[Setting], str],
    outcome: Callable[[Result], str],
    records: Path | None = None,
) -> list[Result]:
    """Results of all settings, in their order, with a line of progress for each.

    Parameters
    ----------
    settings : sequence
    measure : callable
        Result of a setting; with records one that json can hold.
    name : callable
        A setting in one line, different for each.
    outcome : callable
        A result in a few words.
    records : Path, optional
        Folder of results that a stopped scan goes on from; its name stands for data and code.

    Returns
    -------
    list
    """
    begun, measured, results = time.monotonic(), 0, []
    for number, setting in enumerate(settings, 1):
        record = None if records is None else record_of(records, name(setting))
        measured += record is None or not record.exists()
        work = partial(measure, setting)
        result = work() if record is None else remembered(record, work)
        left_s = (time.monotonic() - begun) / max(measured, 1) * (len(settings) - number)
        LOG.info(
            "%d of %d, %s: %s; about %.0f s left",
            number,
            len(settings),
            name(setting),
            outcome(result),
            left_s,
        )
        results.append(result)
    return results


def learned(
    candidate: Candidate, frames: Frames, task: Task, step_weights: NDArray[np.int64] | None = None
) -> Chain:
    """The chain of a candidate from frames on its grid; steps are weighted as in `registry.learn`.

    Raises
    ------
    DataError
        The window is too short for the lag, or the model cannot use the data.
    """
    grid = grid_of(candidate, task.grid)
    return registry.learn(
        candidate.model, frames, grid, candidate.lag, task.estimator, step_weights, **candidate.options
    )


def observed_curves(run: Realisation, start: Start, splits: Splits) -> NDArray[np.float64]:
    """Mixing curves of the DEM from a start, (length + 1, 4)."""
    values = run.values[start.frame : start.last + 1]
    return remaining_from_positions(values[:, 0], values[:, 1], *splits)


def predicted_curves(
    chain: Chain,
    run: Realisation,
    start: Start,
    lag: int,
    splits: Splits,
    fractions: Fractions | ShareFractions | None = None,
) -> NDArray[np.float64]:
    """A chain's expected mixing curves from a start, at every frame, (length + 1, 4).

    Between two steps of the chain by its fractions of a step, or without them by straight lines, so that all
    candidates are judged at the same frames. Lines serve the study of many lags (trade-off): up to 0.3 s they
    err by 2 % more.
    """
    if fractions is not None:
        begin = run.leading_to(chain.grid, start.frame, lag)
        return mixing_by_frame(chain, fractions, begin, splits, start.length)
    steps = -(-start.length // lag)
    curves = chain.mixing(run.leading_to(chain.grid, start.frame, lag), *splits, steps)
    return at_frames(curves, lag, start.length)


def at_frames(curves: NDArray[np.float64], lag: int, length: int) -> NDArray[np.float64]:
    """Curves at every lag, interpolated linearly to every frame from 0 to ``length``."""
    frames = np.arange(length + 1)
    return np.stack([np.interp(frames, np.arange(len(curves)) * lag, curve) for curve in curves.T], axis=1)


def rms_over_starts(errors: Sequence[NDArray[np.float64]], seed: int) -> tuple[float, float, float]:
    """Rms of the errors of curves from several starts, and the ends of its 95 % interval over starts."""
    table = stacked(list(errors))
    weights = resampled(np.zeros(len(table), np.int64), REPLICATES, np.random.default_rng(seed))
    return float(rms(table)), *interval(rms, table, weights)


def timed(kernel: Callable[[], Value]) -> tuple[Value, float]:
    """Result of a kernel and the least processor time it took, which other work hardly changes [s]."""
    taken: list[float] = []
    while not taken or (len(taken) < REPEATS and sum(taken) < ENOUGH_S):
        begin = time.process_time()
        value = kernel()
        taken.append(time.process_time() - begin)
    return value, min(taken)


def running_cost(chain: Chain, begin: Frames, task: Task) -> dict[str, float]:
    """Processor time of a run over the length of the comparison window, with the data in memory.

    Returns
    -------
    dict
        curves_s: of the expected mixing curves; paths_s: of moving every particle, which all models and the
        DEM do alike [s].
    """
    steps = -(-task.comparison // lag_frames(chain.lag_s, begin.interval_s))

    def paths() -> None:
        for _ in chain.paths(begin, steps, np.random.default_rng(PATHS_SEED)):
            pass

    return {
        "curves_s": timed(lambda: chain.mixing(begin, *task.splits, steps))[1],
        "paths_s": timed(paths)[1],
    }


def named(candidate: Candidate, case_grid: Grid, interval_s: float) -> dict[str, Any]:
    """Columns that identify the candidate of a row."""
    grid = grid_of(candidate, case_grid)
    return {
        "model": candidate.name,
        "cell_m": grid.cell_width_m,
        "lag_s": candidate.lag * interval_s,
        "options": candidate.options_text,
    }
