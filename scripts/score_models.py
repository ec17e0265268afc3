# SPDX-License-Identifier: GPL-3.0-or-later
"""Every model chosen by validation and tested once: results/<case>/selection.csv, scores.csv and curves."""

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from bedchain.chains import registry
from bedchain.chains.registry import CaseChains
from bedchain.comparison.curves import curve_table
from bedchain.errors import DataError, UserError
from bedchain.figures.model_styles import BASELINE
from bedchain.files import write_arrays, write_csv
from bedchain.measures.batch import Batch
from bedchain.measures.choice import choose_lag, raised
from bedchain.measures.choice_of_cells import choose_cells
from bedchain.measures.dispersion_by_lag import dispersion_by_lag, thinned
from bedchain.measures.lagrangian import Statistics
from bedchain.measures.mixing import Splits
from bedchain.stage import LOG, run_stage
from bedchain.studies.candidates import Candidate
from bedchain.studies.records import remove_other_results, stamp
from bedchain.studies.scan import Task, named
from bedchain.studies.scores.held_out import HeldOut, hold_out
from bedchain.studies.scores.predictions import Predictions, batch_shares, dem_statistics, predict_held_out
from bedchain.studies.scores.rows import dem_rows, score_rows
from bedchain.studies.scores.search_spaces import candidates
from bedchain.studies.scores.selection import disagreement, select
from bedchain.trajectory.frames import Window, lag_frames
from bedchain.trajectory.realisations import Realisation, open_bed, open_repeats
from bedchain.trajectory.regrid import regrid
from bedchain.trajectory.store import BedFiles
from bedchain.uncertainty.bands import memory

COLUMNS = ["model", "cell_m", "lag_s", "options", "quantity", "time_s", "value", "ci_low", "ci_high",
           "noise_floor", "unit", "window"]  # fmt: skip


@dataclass(frozen=True)
class ScoreFiles:
    """Files to make.

    Attributes
    ----------
    scores : Path
        Scores of the settings that validation chose, of the case's own static chain, and of the chain by the
        rule of choose_chain (model ``chosen``).
    selection : Path
        Validation of all candidates.
    mixing, lagrangian : Path
        Mixing curves of one start; Lagrangian curves.
    best : Path
        The best model's batch.
    """

    scores: Path
    selection: Path
    mixing: Path
    lagrangian: Path
    best: Path


@dataclass(frozen=True)
class Observed:
    """Marked groups and batch that chains and DEM are compared by."""

    splits: Splits
    batch: Batch


@dataclass(frozen=True)
class ScoredChains(CaseChains):
    """The case's own chains, and what all chains beside them share.

    Attributes
    ----------
    seed : int
        Of the Monte Carlo runs.
    diameter_m : float
        Of a particle: no cell is smaller [m].
    """

    seed: int
    diameter_m: float


def score_models(
    bed: BedFiles, repeats: list[Path], files: ScoreFiles, learning: Window, comparison: Window,
    observed: Observed, case: ScoredChains, tried: list[Candidate] | None = None,
) -> None:  # fmt: skip
    """Choose the setting of each model inside the learning window, learn again, and test once.

    Parameters
    ----------
    bed : BedFiles
    repeats : list of Path
        ``trajectory.npy`` of each repeat of the run, its ``trajectory.json`` beside it; may be empty.
    files : ScoreFiles
    learning, comparison : Window
    observed : Observed
    case : ScoredChains
    tried : list of Candidate, optional
        All settings of all models by default.

    Raises
    ------
    UserError, DataError
        A window or a repeat lacks frames; no model could be validated.
    """
    run = open_bed(bed)
    runs = [run, *open_repeats(repeats, run)]
    grid = case.flat_grid(run.width_m, run.height_m)
    which = learning.frames(run.times_s)
    compared = comparison.frames(run.times_s)
    if compared.start + 1 < which.stop:
        raise UserError("comparison.start_s is inside the learning window: take at least learning.end_s")
    splits, batch = observed.splits, observed.batch
    lag = lag_frames(case.lag_s, run.interval_s)
    spacing = math.ceil(memory(run.frames(grid, which), splits.split_x_m))
    task = Task(grid, splits, case.estimator, spacing, compared.stop - 1 - compared.start)
    rule = by_rule(run, which, splits, case.diameter_m)
    if tried is None:
        tried = candidates(registry.LEARNERS, grid, lag, case.diameter_m)
        tried += [rule] if rule and rule not in tried else []
    about: dict[str, object] = {"task": repr(task), "learning": learning, "comparison": comparison}
    folder = files.scores.parent / "candidates" / stamp([bed.trajectory, bed.metadata], about)
    kept = remove_other_results(folder)
    table = select(tried, run, which, task, kept)
    table["rule"] = [int(one == rule) for one in tried]
    for row in table[table["rule"] == 1].to_dict("records"):
        if words := disagreement(table, pd.Series(row)):
            LOG.warning(words)
    chosen = {one.name: one for one, mark in zip(tried, table["chosen"], strict=True) if mark}
    winner = table.loc[table["best"] == 1, "model"].item()
    held = hold_out(runs, grid, comparison, spacing, splits, batch.batch_height_m, batch.moments_s)
    LOG.info("%d starts, %d frames apart; %d repeats; noise floor: spread between %s", len(held.starts),
             spacing, len(repeats), "runs" if held.repeated else "starts")  # fmt: skip
    dem = [dem_statistics(held, number) for number in range(len(runs))]
    found = [{"model": "dem"} | row for row in dem_rows(held, dem)]
    trials: dict[str, Predictions] = {}
    without_search = {BASELINE: Candidate("static", case.columns, case.rows, lag)}
    without_search |= {registry.CHOSEN: rule} if rule else {}
    for name, one in {**chosen, **without_search}.items():
        LOG.info("test of %s: %s", name, one.key)
        trials[name] = predict_held_out(one, which, held, task, case.seed)
        if name != BASELINE or one not in chosen.values():
            labels = named(one, grid, run.interval_s)
            labels |= {"model": name} if name == registry.CHOSEN else {}
            found += [labels | row for row in score_rows(trials[name], held)]
    write_csv(table, files.selection)
    write_csv(pd.DataFrame(found).reindex(columns=COLUMNS), files.scores)
    write_csv(mixing_table(held, trials, winner), files.mixing)
    statistics = {name: [one for one, _ in trial.lagrangian] for name, trial in trials.items()}
    write_csv(lagrangian_table({"dem": dem, **statistics}), files.lagrangian)
    write_arrays(files.best, batch_of_best(trials[winner], held, winner, chosen[winner], case.seed))


def by_rule(run: Realisation, learning: slice, splits: Splits, diameter_m: float) -> Candidate | None:
    """The static chain with the lag and the cells of choose_chain's rule; None where that refuses."""
    values = run.values[learning]
    x_m, z_m = thinned(values[:, 0]), thinned(values[:, 1])
    try:
        curve = dispersion_by_lag(x_m, z_m, run.interval_s)
        lag = raised(choose_lag(curve, values.shape[2], diameter_m), curve, np.stack((x_m, z_m)))
    except DataError as problem:
        LOG.warning("no setting by rule: %s", problem)
        return None
    cells = choose_cells((x_m, z_m), (run.width_m, run.height_m), splits, diameter_m, lag.frames)
    return Candidate("static", cells.columns, cells.rows, lag.frames)


def mixing_table(held: HeldOut, trials: dict[str, Predictions], winner: str) -> pd.DataFrame:
    """Curves of the paper's start: DEM, repeats, chains, and one Monte Carlo of the best.

    Returns
    -------
    DataFrame
        As mixing.csv; repeats have their own starts at the same time.
    """
    parts = []
    first = [number for number, start in enumerate(held.starts) if start.number == 0]
    for number in first:
        start = held.starts[number]
        times = held.runs[start.run].times_s[start.frame : start.last + 1]
        source = "dem" if start.run == 0 else f"dem_{start.run}"
        parts.append(curve_table(times, source, held.curves[number, : start.length + 1]))
    times = held.runs[0].times_s[held.starts[0].frame : held.starts[0].last + 1]
    for name, trial in trials.items():
        parts.append(curve_table(times, name, trial.curves[0, : times.size]))
    parts.append(curve_table(times, f"{winner}_monte_carlo", trials[winner].drawn[0, : times.size]))
    return pd.concat(parts, ignore_index=True)


def lagrangian_table(found: dict[str, list[Statistics]]) -> pd.DataFrame:
    """Mean-square displacement and autocorrelation of each source, means over the runs.

    Returns
    -------
    DataFrame
        source, axis, time_s, span_s, msd_m2, autocorrelation_1.
    """
    parts = []
    for source, runs in found.items():
        squared, product = (
            np.mean([getattr(one, name).mean(axis=0) for one in runs], axis=0)
            for name in ("squared_m2", "product_m2")
        )
        for column, axis in enumerate("xz"):
            about = {"source": source, "axis": axis, "time_s": runs[0].times_s, "span_s": runs[0].span_s}
            values = {
                "msd_m2": squared[:, column],
                "autocorrelation_1": product[:, column] / product[0, column],
            }
            parts.append(pd.DataFrame(about | values))
    return pd.concat(parts, ignore_index=True)


def batch_of_best(trial: Predictions, held: HeldOut, model: str, one: Candidate, seed: int) -> dict[str, Any]:
    """Where the best model takes the batch, as chain_<model>.npz holds it, on the case's cells."""
    start, inside = held.starts[0], held.moments[held.moments <= held.starts[0].length]
    begin = held.runs[0].leading_to(trial.chain.grid, start.frame, trial.lag)
    rng = np.random.default_rng(seed)
    drawn = batch_shares(trial.chain, begin, held.batches[0], inside, trial.lag, rng)
    return {
        "model": np.array(model),
        "settings": np.array(json.dumps(named(one, held.grid, held.interval_s))),
        "moments_s": inside * held.interval_s,
        "batch_share": trial.densities[0, : inside.size],
        "batch_share_monte_carlo": regrid(drawn, trial.chain.grid, held.grid),
    }


if rule := globals().get("snakemake"):
    run_stage(score_models, rule)
