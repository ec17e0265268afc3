# SPDX-License-Identifier: GPL-3.0-or-later
"""Selection of each model's setting: five blocks of the learning window are left out in turn and predicted.

No frame after the learning window is used: the run is cut at its end.
"""

import logging
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from bedchain.errors import DataError, UserError
from bedchain.studies.candidates import Candidate, grid_of
from bedchain.studies.five_folds import over_folds, squared_errors, starts_by_fold
from bedchain.studies.marked_starts import FOLDS
from bedchain.studies.scan import Task, learned, named, running_cost, scan, timed
from bedchain.trajectory.realisations import Realisation
from bedchain.uncertainty.bands import block_band

FOLD_COLUMNS = [f"fold_{number}" for number in range(1, FOLDS + 1)]
LOG = logging.getLogger(__name__)


def validated(candidate: Candidate, run: Realisation, learning: slice, task: Task) -> dict[str, Any]:
    """Validation of a candidate: learned without each block of the learning window, judged on that block.

    Parameters
    ----------
    candidate : Candidate
    run : Realisation
        Frames after the learning window are not used.
    learning : slice
        Its frames.
    task : Task

    Returns
    -------
    dict
        validation_rms (of the four curves over all folds, starts and frames) with ci_low and ci_high from
        leaving each fold out, fold_1 to fold_5 (the rms of each), starts, learn_s, curves_s and paths_s
        (`running_cost`), problem (empty without one).
    """
    result: dict[str, Any] = {"validation_rms": np.nan, "ci_low": np.nan, "ci_high": np.nan}
    result |= dict.fromkeys(FOLD_COLUMNS, np.nan)
    result |= {"starts": 0, "learn_s": np.nan, "curves_s": np.nan, "paths_s": np.nan, "problem": ""}
    starts = starts_by_fold(learning, candidate.lag, task.spacing)
    longest = min(start.length for of_block in starts for start in of_block)
    if candidate.lag > longest:
        lag_s, longest_s = (n * run.interval_s for n in (candidate.lag, longest))
        return result | {"problem": f"lag {lag_s:g} s is longer than the {longest_s:g} s to validate"}
    try:
        frames = run.frames(grid_of(candidate, task.grid), learning)
        chain, learn_s = timed(lambda: learned(candidate, frames, task))
        squares = squared_errors(candidate, run, frames, learning, task)
        cost = running_cost(chain, run.leading_to(chain.grid, starts[-1][0].frame, candidate.lag), task)
    except DataError as problem:
        return result | {"problem": str(problem)}
    error, *ends = over_folds(squares)
    folds = [float(np.sqrt(np.mean(square))) for square in squares]
    return result | dict(zip(FOLD_COLUMNS, folds, strict=True)) | {
        "validation_rms": error, "ci_low": ends[0], "ci_high": ends[1],
        "starts": sum(map(len, starts)), "learn_s": learn_s, **cost,
    }  # fmt: skip


def disagreement(table: pd.DataFrame, rule: pd.Series) -> str:
    """Where validation prefers another setting of the rule's model beyond its band; empty where it does not.

    Parameters
    ----------
    table : DataFrame
        Of `select`.
    rule : Series
        Its row of the setting by rule.

    Returns
    -------
    str
        Both settings with their errors, and the band of the difference of their mean squares over the folds.
    """
    alike = table[(table["model"] == rule["model"]) & table["validation_rms"].notna()]
    if alike.empty or np.isnan(rule["validation_rms"]):
        return ""
    best = alike.loc[alike["validation_rms"].idxmin()]
    differences = best[FOLD_COLUMNS].to_numpy(float) ** 2 - rule[FOLD_COLUMNS].to_numpy(float) ** 2
    left_out = [np.delete(differences, fold).mean() for fold in range(FOLDS)]
    _, high = block_band(differences.mean(), np.array(left_out))
    if not high < 0:
        return ""
    settings = [
        f"{row['cell_m']:.3g} m and {row['lag_s']:g} s ({row['validation_rms']:.3g})" for row in (best, rule)
    ]
    return f"validation prefers {settings[0]} to {settings[1]} by the rule, beyond its band: try both"


def select(
    candidates: Sequence[Candidate], run: Realisation, learning: slice, task: Task, records: Path
) -> pd.DataFrame:
    """Validation of all candidates, with the best of each model and the best of all marked.

    Parameters
    ----------
    candidates : sequence of Candidate
    run : Realisation
    learning : slice
        Frames of the learning window.
    task : Task
    records : Path
        Folder of results that a stopped selection goes on from; its name stands for data and code.

    Returns
    -------
    DataFrame
        A row for each candidate, in their order: model, cell_m, lag_s, options, those of `validated`, chosen
        and best (0 or 1).

    Raises
    ------
    UserError
        No candidate could be validated.
    """
    run = Realisation(
        run.name, run.values[: learning.stop], run.times_s[: learning.stop], run.width_m, run.height_m,
        run.has_velocities,
    )  # fmt: skip
    results = scan(
        candidates,
        lambda candidate: validated(candidate, run, learning, task),
        lambda candidate: candidate.key,
        lambda result: result["problem"] or f"validation rms {result['validation_rms']:.4f}",
        records,
    )
    labels = [named(candidate, task.grid, run.interval_s) for candidate in candidates]
    rows = [label | result for label, result in zip(labels, results, strict=True)]
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
