# SPDX-License-Identifier: GPL-3.0-or-later
"""Measured cost of each model: results/<case>/timing.csv. The DEM's own time comes from its manifest."""

import time
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from bedchain.chains import counting, dynamic, registry
from bedchain.chains.between_steps import Fractions, learn_fractions, mixing_by_frame
from bedchain.chains.chain import Chain
from bedchain.chains.counting import Counts
from bedchain.chains.estimators import transition_matrix
from bedchain.chains.registry import ModelSettings
from bedchain.files import write_csv
from bedchain.measures.mixing import Splits
from bedchain.meter import forget_peak, peak_memory_mb
from bedchain.stage import LOG, run_stage
from bedchain.studies.cost.window_time import Row, dem_row
from bedchain.trajectory.frames import Frames, Lag, Window
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import open_bed
from bedchain.trajectory.store import BedFiles, read_manifest

# a median of many runs where they are short, of three at least, so that one that compiles does not move it;
# of two where both take half a second
REPEATS, FEWEST = 15, 3
ENOUGH_S, LONG_S = 0.2, 0.5


def time_models(
    dem: Path | list[Path], bed: BedFiles, transitions: list[Path], timing: Path,
    learning: Window, comparison: Window, splits: Splits, settings: ModelSettings,
) -> None:  # fmt: skip
    """Time counting, estimating, exact propagation and Monte Carlo of each chain, beside the DEM.

    Parameters
    ----------
    dem : Path or empty list
        ``dem.json``; empty where the frames are not of a simulation, which is then not timed.
    bed : BedFiles
    transitions : list of Path
        ``transitions_<model>.npz`` of each model.
    timing : Path
        Gets stage, wall_s, cpu_s, peak_rss_mb, work, work_unit; medians of repeats, data in memory, compiled.
    learning, comparison : Window
    splits : Splits
    settings : ModelSettings
        Options by model.
    """
    run = open_bed(bed)
    rows = [dem_row(read_manifest(dem), *comparison)] if isinstance(dem, Path) else []
    which = comparison.frames(run.times_s)
    of_grid = lru_cache(maxsize=1)(lambda grid: in_memory(run.frames(grid, learning.frames(run.times_s))))
    for path in transitions:
        chain, fractions = registry.load(path), registry.load_fractions(path)
        model, lag = chain.name, Lag.of(chain.lag_s, run.interval_s)
        start = in_memory(run.up_to(comparison.start_s, lag.frames, chain.grid))
        options = settings.options.get(model, {})
        rows += learning_rows(model, of_grid(chain.grid), chain.grid, lag, settings.estimator, options)
        length = which.stop - 1 - which.start
        rows += running_rows(chain, fractions, start, length, splits, settings.seed)
    write_csv(pd.DataFrame(rows), timing)
    for row in rows:
        LOG.info("%-22s %.4g s", row["stage"], row["wall_s"])


def learning_rows(
    model: str, learning: Frames, grid: Grid, lag: Lag, estimator: str, options: dict[str, Any]
) -> list[Row]:
    """Learning of one chain; of those of the paper counting and estimating apart.

    Parameters
    ----------
    model : str
    learning : Frames
        The learning window, in memory.
    grid : Grid
    lag : Lag
        Of a step.
    estimator : str
    options : dict
        Settings of this model only.

    Returns
    -------
    list of dict
    """
    cells, n_cells = learning.cells, grid.n_cells
    moves = (len(cells) - lag.frames) * cells.shape[1]
    if model not in ("static", "dynamic"):

        def learn() -> None:
            registry.learn(model, learning, grid, lag.frames, estimator, **options)
            learn_fractions(learning, n_cells, lag.frames, estimator)

        return [measured(f"{model}_learn", learn, moves, "particle moves")]
    counts: list[Counts] = []  # of the last run

    def count() -> None:
        double = [counting.count_pairs(cells, n_cells, lag.frames)] if model == "dynamic" else []
        counts[:] = [*double, counting.count_moves(cells, n_cells, lag.frames)]

    def estimate() -> None:
        if model == "dynamic":
            dynamic.from_counts(counts[0], counts[1], grid, lag.seconds, estimator)
        else:
            transition_matrix(counts[0], estimator)

    return [
        measured(f"{model}_count", count, moves, "particle moves"),
        measured(f"{model}_matrix", estimate, n_cells, "cells"),
    ]


def running_rows(
    chain: Chain, fractions: Fractions, start: Frames, length: int, splits: Splits, seed: int
) -> list[Row]:
    """Exact mixing curves at every frame, and a Monte Carlo of every particle, over the comparison window.

    Parameters
    ----------
    chain : Chain
    fractions : Fractions
        Of its step.
    start : Frames
        Up to the start of the window, in memory.
    length : int
        Frames of the window after its start.
    splits : Splits
    seed : int

    Returns
    -------
    list of dict
    """
    steps = -(-length // fractions.lag)
    moves = steps * start.cells.shape[1]

    def monte_carlo() -> None:
        for _ in chain.paths(start, steps, np.random.default_rng(seed)):
            pass

    def exact() -> None:
        mixing_by_frame(chain, fractions, start, splits, length)

    return [
        measured(f"{chain.name}_exact", exact, steps, "steps"),
        measured(f"{chain.name}_monte_carlo", monte_carlo, moves, "particle moves"),
    ]


def measured(name: str, kernel: Callable[[], Any], work: float, work_unit: str) -> Row:
    """Medians of repeated runs of a kernel.

    Parameters
    ----------
    name : str
        Name of the stage.
    kernel : callable
        What to time.
    work : float
        How much one run does, in ``work_unit``.
    work_unit : str

    Returns
    -------
    dict
        One row of timing.csv; the peak is that of the whole process while the kernel ran.
    """
    if not forget_peak():
        LOG.info("the peak of the memory use cannot be reset here: it is that of the process so far")
    wall: list[float] = []
    cpu: list[float] = []
    while not are_enough(wall):
        begin = time.perf_counter(), time.process_time()
        kernel()
        wall.append(time.perf_counter() - begin[0])
        cpu.append(time.process_time() - begin[1])
    return {
        "stage": name, "wall_s": float(np.median(wall)), "cpu_s": float(np.median(cpu)),
        "peak_rss_mb": peak_memory_mb(), "work": work, "work_unit": work_unit,
    }  # fmt: skip


def are_enough(wall_s: list[float]) -> bool:
    """Whether runs of these times [s] give a median."""
    if len(wall_s) > 1 and min(wall_s) > LONG_S:
        return True
    return len(wall_s) >= FEWEST and (len(wall_s) >= REPEATS or sum(wall_s) >= ENOUGH_S)


def in_memory(frames: Frames) -> Frames:
    """Frames copied out of their memory maps, so that no disk is timed."""
    vx, vz = (None if array is None else np.array(array) for array in (frames.vx_m_s, frames.vz_m_s))
    return Frames(
        np.array(frames.times_s), np.array(frames.x_m), np.array(frames.z_m), np.array(frames.cells), vx, vz
    )


if rule := globals().get("snakemake"):
    run_stage(time_models, rule)
