# SPDX-License-Identifier: GPL-3.0-or-later
"""Every model chosen by validation and tested once: results/<case>/selection.csv, scores.csv and curves."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from bedchain.chains import registry
from bedchain.comparison.curves import curve_table
from bedchain.errors import UserError
from bedchain.figures.model_styles import BASELINE
from bedchain.files import write_arrays, write_csv
from bedchain.measures.lagrangian import Statistics
from bedchain.stage import LOG, stage
from bedchain.studies.records import only, stamp
from bedchain.studies.scan import Task, named
from bedchain.studies.scores.candidates import Candidate, candidates
from bedchain.studies.scores.held_out import HeldOut, hold_out
from bedchain.studies.scores.rows import dem_rows, score_rows
from bedchain.studies.scores.selection import select
from bedchain.studies.scores.tested_chain import Trial, batch_shares, dem_statistics, try_out
from bedchain.trajectory.frames import lag_frames, window
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import open_realisation, open_repeats
from bedchain.trajectory.regrid import regrid
from bedchain.uncertainty.bands import memory

COLUMNS = ["model", "cell_m", "lag_s", "options", "quantity", "time_s", "value", "ci_low", "ci_high",
           "noise_floor", "unit", "window"]  # fmt: skip


def score_models(
    trajectory: Path, metadata: Path, repeats: list[Path],
    scores: Path, selection: Path, mixing: Path, lagrangian: Path, best: Path,
    learning: dict[str, float], comparison: dict[str, float], columns: int, rows: int, diameter_m: float,
    lag_s: float, estimator: str, split_x_m: float, split_z_m: float,
    batch_height_m: float, moments_s: list[float], seed: int,
    tried: list[Candidate] | None = None,
) -> None:  # fmt: skip
    """Choose the setting of each model inside the learning window, learn again, and test once.

    Parameters
    ----------
    trajectory, metadata : Path
        ``trajectory.npy`` and ``trajectory.json``.
    repeats : list of Path
        ``trajectory.npy`` of each repeat of the run, its ``trajectory.json`` beside it; may be empty.
    scores, selection, mixing, lagrangian, best : Path
        Files to make: scores of the chosen settings and of the case's own static chain; validation of all
        candidates; curves of one start; Lagrangian curves; the best model's batch.
    learning, comparison : dict of str to float
        ``start_s`` and ``end_s`` of the windows [s].
    columns, rows : int
        The case's cells.
    diameter_m : float
        Of a particle: no cell is smaller [m].
    lag_s : float
        The case's lag [s].
    estimator : {"literal", "per_step", "pooled"}
        How counts become probabilities.
    split_x_m, split_z_m : float
        Lines between left and right, low and up [m].
    batch_height_m : float
        Height of the batch [m].
    moments_s : list of float
        When the batch is looked at [s].
    seed : int
        Of the Monte Carlo runs.
    tried : list of Candidate, optional
        All settings of all models by default.

    Raises
    ------
    UserError, DataError
        A window or a repeat lacks frames; no model could be validated.
    """
    run = open_realisation("the run", trajectory, metadata)
    runs = [run, *open_repeats(repeats, run)]
    grid = Grid(run.width_m, run.height_m, columns, rows)
    start_s, end_s = comparison["start_s"], comparison["end_s"]
    which = window(run.times_s, learning["start_s"], learning["end_s"])
    compared = window(run.times_s, start_s, end_s)
    if compared.start + 1 < which.stop:
        raise UserError("comparison.start_s is inside the learning window: take at least learning.end_s")
    splits, lag = (split_x_m, split_z_m), lag_frames(lag_s, run.interval_s)
    spacing = math.ceil(memory(run.frames(grid, which), split_x_m))
    task = Task(grid, splits, estimator, spacing, compared.stop - 1 - compared.start)
    tried = candidates(registry.LEARNERS, grid, lag, diameter_m) if tried is None else tried
    about = {"task": repr(task), "learning": learning, "comparison": comparison}
    kept = only(scores.parent / "candidates" / stamp([trajectory, metadata], about))
    table = select(tried, run, which, task, kept)
    chosen = {one.name: one for one, mark in zip(tried, table["chosen"], strict=True) if mark}
    winner = table.loc[table["best"] == 1, "model"].item()
    held = hold_out(runs, grid, (start_s, end_s), spacing, splits, batch_height_m, moments_s)
    LOG.info("%d starts, %d frames apart; %d repeats; noise floor: spread between %s", len(held.starts),
             spacing, len(repeats), "runs" if held.repeated else "starts")  # fmt: skip
    dem = [dem_statistics(held, number) for number in range(len(runs))]
    found = [{"model": "dem"} | row for row in dem_rows(held, dem)]
    trials: dict[str, Trial] = {}
    for name, one in {**chosen, BASELINE: Candidate("static", columns, rows, lag)}.items():
        LOG.info("test of %s: %s", name, one.key)
        trials[name] = try_out(one, which, held, task, seed)
        if name != BASELINE or one not in chosen.values():
            labels = named(one, grid, run.interval_s)
            found += [labels | row for row in score_rows(trials[name], held)]
    write_csv(table, selection)
    write_csv(pd.DataFrame(found).reindex(columns=COLUMNS), scores)
    write_csv(mixing_table(held, trials, winner), mixing)
    statistics = {name: [one for one, _ in trial.lagrangian] for name, trial in trials.items()}
    write_csv(lagrangian_table({"dem": dem, **statistics}), lagrangian)
    write_arrays(best, batch_of_best(trials[winner], held, winner, chosen[winner], seed))


def mixing_table(held: HeldOut, trials: dict[str, Trial], winner: str) -> pd.DataFrame:
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
        source = "dem" if start.run == 0 else f"repeat_{start.run}"
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


def batch_of_best(trial: Trial, held: HeldOut, model: str, one: Candidate, seed: int) -> dict[str, Any]:
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


if "snakemake" in globals():
    with stage(snakemake.log[0]):
        score_models(
            Path(snakemake.input.trajectory),
            Path(snakemake.input.metadata),
            [Path(file) for file in snakemake.input.repeats],
            Path(snakemake.output.scores),
            Path(snakemake.output.selection),
            Path(snakemake.output.mixing),
            Path(snakemake.output.lagrangian),
            Path(snakemake.output.best),
            snakemake.params.learning,
            snakemake.params.comparison,
            snakemake.params.columns,
            snakemake.params.rows,
            snakemake.params.diameter_m,
            snakemake.params.lag_s,
            snakemake.params.estimator,
            snakemake.params.split_x_m,
            snakemake.params.split_z_m,
            snakemake.params.batch_height_m,
            snakemake.params.moments_s,
            snakemake.params.seed,
        )
