# SPDX-License-Identifier: GPL-3.0-or-later
"""Choosing each model's setting inside the learning window: fitted on its first part, validated on the rest.

No frame after the learning window is touched here; a run is handed over cut at its end.
"""

import logging
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from bedchain.chains import registry
from bedchain.chains.chain import Chain
from bedchain.errors import DataError, UserError
from bedchain.measures.mixing import remaining_from_positions
from bedchain.studies.records import record_of, remembered
from bedchain.studies.scores.candidates import Candidate, grid_of
from bedchain.studies.scores.marked_starts import Start, split, starts_in
from bedchain.trajectory.cell_store import HISTORY_LAGS
from bedchain.trajectory.frames import Frames, lag_frames
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import Run
from bedchain.uncertainty.deviations import interval, resampled, rms, stacked

LOG = logging.getLogger(__name__)

Made = TypeVar("Made")
Result = dict[str, Any]
# a kernel is timed so many times, or fewer once they took so long together; the least of all counts, since
# the first may have to load compiled code, which takes about a second
REPEATS, ENOUGH_S = 4, 2.0
REPLICATES = 1000
# of the intervals only: the same data give the same interval
INTERVAL_SEED = 17


@dataclass(frozen=True)
class Task:
    """What all candidates share.

    Parameters
    ----------
    grid : Grid
        The case's cells.
    splits : (float, float)
        Lines between left and right, low and up [m].
    estimator : str
        How counts become probabilities.
    spacing : int
        Frames between starts.
    comparison : int
        Frame intervals in the comparison window: cost is that of its length.
    """

    grid: Grid
    splits: tuple[float, float]
    estimator: str
    spacing: int
    comparison: int


def learned(candidate: Candidate, frames: Frames, task: Task) -> Chain:
    """The chain of a candidate from frames on its grid.

    Raises
    ------
    DataError
        The window is too short for the lag, or the model cannot use the data.
    """
    grid = grid_of(candidate, task.grid)
    return registry.learn(
        candidate.model, frames, grid, candidate.lag, task.estimator, None, **candidate.options
    )


def leading_to(run: Run, grid: Grid, frame: int, lag: int) -> Frames:
    """Frames up to a start, with those before it that a chain may look back to."""
    return run.leading_to(grid, frame, HISTORY_LAGS * lag)


def observed_curves(run: Run, start: Start, splits: tuple[float, float]) -> NDArray[np.float64]:
    """The DEM's own mixing curves from a start, (length + 1, 4)."""
    values = run.values[start.frame : start.last + 1]
    return remaining_from_positions(values[:, 0], values[:, 1], *splits)


def predicted_curves(
    chain: Chain, run: Run, start: Start, lag: int, splits: tuple[float, float]
) -> NDArray[np.float64]:
    """A chain's expected mixing curves from a start, at every frame, (length + 1, 4).

    Between two steps of the chain the curves are straight: all candidates are judged at the same frames.
    """
    steps = -(-start.length // lag)
    curves = chain.mixing(leading_to(run, chain.grid, start.frame, lag), *splits, steps)
    return at_frames(curves, lag, start.length)


def at_frames(curves: NDArray[np.float64], lag: int, length: int) -> NDArray[np.float64]:
    """Curves given at every lag, by straight lines at every frame from 0 to ``length``."""
    frames = np.arange(length + 1)
    return np.stack([np.interp(frames, np.arange(len(curves)) * lag, one) for one in curves.T], axis=1)


def timed(kernel: Callable[[], Made]) -> tuple[Made, float]:
    """What a kernel makes, and the least processor time it took, which other work hardly changes [s]."""
    taken: list[float] = []
    while not taken or (len(taken) < REPEATS and sum(taken) < ENOUGH_S):
        begin = time.process_time()
        made = kernel()
        taken.append(time.process_time() - begin)
    return made, min(taken)


def validated(candidate: Candidate, run: Run, learning: slice, task: Task) -> Result:
    """Fit a candidate on the first part of the learning window and judge it on the rest.

    Parameters
    ----------
    candidate : Candidate
    run : Run
        Frames after the learning window are not used.
    learning : slice
        Its frames.
    task : Task

    Returns
    -------
    dict
        validation_rms, ci_low, ci_high (of the four curves over all starts and frames), starts, learn_s,
        curves_s and paths_s (`running_cost`), problem (empty where all went well).
    """
    result: Result = {"validation_rms": np.nan, "ci_low": np.nan, "ci_high": np.nan}
    result |= {"starts": 0, "learn_s": np.nan, "curves_s": np.nan, "paths_s": np.nan, "problem": ""}
    fit, part = split(learning)
    starts = starts_in(part, task.spacing)
    if candidate.lag > min(start.length for start in starts):
        lag_s, longest_s = (n * run.interval_s for n in (candidate.lag, min(s.length for s in starts)))
        return result | {"problem": f"lag {lag_s:g} s is longer than the {longest_s:g} s to validate"}
    try:
        frames = run.frames(grid_of(candidate, task.grid), fit)
        chain, learn_s = timed(lambda: learned(candidate, frames, task))
        pairs = [
            (
                predicted_curves(chain, run, start, candidate.lag, task.splits),
                observed_curves(run, start, task.splits),
            )
            for start in starts
        ]
        cost = running_cost(chain, leading_to(run, chain.grid, starts[0].frame, candidate.lag), task)
    except DataError as problem:
        return result | {"problem": str(problem)}
    error = stacked([model[1:] - dem[1:] for model, dem in pairs])
    weights = resampled(np.zeros(len(error), np.int64), REPLICATES, np.random.default_rng(INTERVAL_SEED))
    low, high = interval(rms, error, weights)
    return result | {
        "validation_rms": float(rms(error)), "ci_low": low, "ci_high": high, "starts": len(starts),
        "learn_s": learn_s, **cost,
    }  # fmt: skip


def running_cost(chain: Chain, begin: Frames, task: Task) -> dict[str, float]:
    """Processor time of a chain over the length of the comparison window, data in memory.

    Returns
    -------
    dict
        curves_s: the expected mixing curves; paths_s: every particle moved, which all models and the DEM do
        alike [s].
    """
    steps = -(-task.comparison // lag_frames(chain.lag_s, begin.interval_s))

    def paths() -> None:
        for _ in chain.paths(begin, steps, np.random.default_rng(INTERVAL_SEED)):
            pass

    return {
        "curves_s": timed(lambda: chain.mixing(begin, *task.splits, steps))[1],
        "paths_s": timed(paths)[1],
    }


def select(tried: Sequence[Candidate], run: Run, learning: slice, task: Task, kept: Path) -> pd.DataFrame:
    """Validate all candidates, and mark the best of each model and the best of all.

    Parameters
    ----------
    tried : sequence of Candidate
    run : Run
    learning : slice
        Frames of the learning window.
    task : Task
    kept : Path
        Folder of results that are taken up again after a stop; its name stands for data and code.

    Returns
    -------
    DataFrame
        A row a candidate, in their order: model, cell_m, lag_s, options, those of `validated`, chosen and
        best (0 or 1).

    Raises
    ------
    UserError
        No candidate at all could be validated.
    """
    run = Run(
        run.name, run.values[: learning.stop], run.times_s[: learning.stop], run.width_m, run.height_m,
        run.has_velocities,
    )  # fmt: skip
    rows = []
    for number, candidate in enumerate(tried, 1):
        record = record_of(kept, candidate.key)
        result = remembered(record, partial(validated, candidate, run, learning, task))
        said = result["problem"] or f"validation rms {result['validation_rms']:.4f}"
        LOG.info("%d of %d, %s: %s", number, len(tried), candidate.key, said)
        rows.append(named(candidate, task.grid, run.interval_s) | result)
    table = pd.DataFrame(rows)
    valid = table["validation_rms"].notna()
    if not valid.any():
        raise UserError(f"no model could be validated: {table['problem'].iloc[0]}")
    chosen = table[valid].groupby("model", sort=False)["validation_rms"].idxmin()
    table["chosen"] = table.index.isin(chosen).astype(int)
    table["best"] = (table.index == table["validation_rms"].idxmin()).astype(int)
    for model in sorted(set(table["model"]) - set(table.loc[valid, "model"])):
        LOG.info("no setting of %s could be validated: it is left out", model)
    return table


def named(candidate: Candidate, case_grid: Grid, interval_s: float) -> Result:
    """The columns that say which candidate a row of a table is of."""
    grid = grid_of(candidate, case_grid)
    return {
        "model": candidate.name,
        "cell_m": grid.cell_width_m,
        "lag_s": candidate.lag * interval_s,
        "options": candidate.options_text,
    }
