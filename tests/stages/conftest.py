# SPDX-License-Identifier: GPL-3.0-or-later
"""A small bed of known motion, and everything that the stages make of it, each by its entry function."""

from types import SimpleNamespace

import numpy as np
import pytest

from assign_cells import assign_cells
from build_transitions import build_transitions
from compare_mixing import compare_mixing
from made.small_bed import (
    BATCH,
    COLUMNS,
    COMPARE,
    DIAMETER,
    FILLED,
    HEIGHT,
    LEARN,
    LEARNING,
    MODELS,
    MOMENTS,
    NUMBER,
    ROWS,
    SPLIT_X,
    SPLIT_Z,
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
    assign_cells(paths.trajectory, paths.metadata, paths.cells, COLUMNS, ROWS, DIAMETER)
    paths.frames = (paths.trajectory, paths.metadata, paths.cells)
    for model in MODELS:
        build_transitions(*paths.frames, paths.transitions[model], model, "pooled", 0.025, *LEARN)
        run_chain(
            *paths.frames, paths.transitions[model], paths.chains[model],
            LEARNING, "pooled", *COMPARE, SPLIT_X, SPLIT_Z, BATCH, MOMENTS, seed=3,
        )  # fmt: skip
    compare_mixing(
        *paths.frames, paths.chains, paths.series, paths.mixing, paths.metrics,
        *COMPARE, SPLIT_X, SPLIT_Z, BATCH, *LEARN, WEIGHT_PA,
    )  # fmt: skip
    return paths
