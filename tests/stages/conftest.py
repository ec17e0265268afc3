# SPDX-License-Identifier: GPL-3.0-or-later
"""A small bed of known motion, and everything that the stages make of it, each by its entry function."""

from types import SimpleNamespace

import numpy as np
import pytest

from assign_cells import Division, assign_cells
from bedchain.chains.registry import ModelSettings
from bedchain.comparison.curves import ChainFiles
from bedchain.measures.batch import Batch
from bedchain.trajectory.store import BedFiles
from build_transitions import build_transitions
from compare_mixing import SolverSeries, Tables, compare_mixing
from made.small_bed import (
    BATCH,
    COLUMNS,
    COMPARE,
    DIAMETER,
    FILLED,
    HEIGHT,
    LEARN,
    MODELS,
    MOMENTS,
    NUMBER,
    ROWS,
    SPLITS,
    TIMES,
    WEIGHT_PA,
    WIDTH,
)
from made.synthetic_bed import rolling_bed, write_run, write_series
from parse_dumps import parse_dumps
from run_chain import run_chain


@pytest.fixture(scope="session")
def frames():
    """Frames (n_frames, 4, n_particles) of two rolls with a random walk."""
    return rolling_bed(NUMBER, WIDTH, FILLED, TIMES)


@pytest.fixture(scope="session")
def bed(tmp_path_factory, frames):
    """Paths of the artefacts of a bed taken through all stages up to the metrics."""
    folder = tmp_path_factory.mktemp("bed")
    names = {
        "trajectory": "trajectory.npy", "metadata": "trajectory.json", "cells": "cells.npz",
        "mixing": "mixing.csv", "metrics": "metrics.csv", "timing": "timing.csv",
    }  # fmt: skip
    paths = SimpleNamespace(folder=folder, **{key: folder / name for key, name in names.items()})
    paths.dem = write_run(folder, frames, TIMES, WIDTH, HEIGHT)
    paths.series = write_series(folder, np.arange(0, 3, 2e-3), WEIGHT_PA, FILLED / 2, NUMBER)
    paths.transitions = {model: folder / f"transitions_{model}.npz" for model in MODELS}
    paths.chains = {model: folder / f"chain_{model}.npz" for model in MODELS}
    parse_dumps(paths.dem, paths.trajectory, paths.metadata, WIDTH, HEIGHT, progress=False)
    assign_cells(BedFiles(paths.trajectory, paths.metadata), paths.cells, Division(COLUMNS, ROWS), DIAMETER)
    paths.files = BedFiles(paths.trajectory, paths.metadata, paths.cells)
    paths.chain_files = ChainFiles(list(MODELS), list(paths.chains.values()))
    for model in MODELS:
        build_transitions(paths.files, paths.transitions[model], model, "pooled", 0.025, LEARN)
        run_chain(
            paths.files, paths.transitions[model], paths.chains[model],
            LEARN, COMPARE, SPLITS, Batch(BATCH, MOMENTS), ModelSettings("pooled", 3),
        )  # fmt: skip
    compare_mixing(
        paths.files, paths.chain_files, SolverSeries(paths.series, LEARN, WEIGHT_PA), [],
        Tables(paths.mixing, paths.metrics), COMPARE, SPLITS, BATCH,
    )  # fmt: skip
    return paths
