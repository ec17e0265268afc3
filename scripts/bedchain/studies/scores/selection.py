# SPDX-License-Identifier: GPL-3.0-or-later
"""Selection of each model's setting: fitted on the first part of the learning window, validated on the rest.

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
from bedchain.studies.marked_starts import split, starts_in
from bedchain.studies.scan import (
    Task,
    learned,
    named,
    observed_curves,
    predicted_curves,
    rms_over_starts,
    running_cost,
    scan,
    timed,
)
from bedchain.studies.scores.held_out import INTERVAL_SEED
from bedchain.trajectory.realisations import Realisation

LOG = logging.getLogger(__name__)


def validated(candidate: Candidate, run: Realisation, learning: slice, task: Task) -> dict[str, Any]:
    """Validation of a candidate: fitted on the first part of the learning window, judged on the rest.

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
        validation_rms, ci_low, ci_high (of the four curves over all starts and frames), starts, learn_s,
        curves_s and paths_s (`running_cost`), problem (empty without one).
    """
    result: dict[str, Any] = {"validation_rms": np.nan, "ci_low": np.nan, "ci_high": np.nan}
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
        cost = running_cost(chain, run.leading_to(chain.grid, starts[0].frame, candidate.lag), task)
    except DataError as problem:
        return result | {"problem": str(problem)}
    error, low, high = rms_over_starts([model[1:] - dem[1:] for model, dem in pairs], INTERVAL_SEED)
    return result | {
        "validation_rms": error, "ci_low": low, "ci_high": high, "starts": len(starts),
        "learn_s": learn_s, **cost,
    }  # fmt: skip


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
