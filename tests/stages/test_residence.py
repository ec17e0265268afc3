# SPDX-License-Identifier: GPL-3.0-or-later
"""Residence times from an open bed on disk to the table and the figure."""

import json

import numpy as np
import pandas as pd
import pytest

from assign_cells import Division, assign_cells
from bedchain.chains.registry import ModelSettings
from bedchain.errors import DataError
from bedchain.figures.style import FigureFiles
from bedchain.measures.batch import Batch
from bedchain.measures.mixing import Splits
from bedchain.trajectory.frames import Window
from bedchain.trajectory.store import BedFiles
from build_transitions import build_transitions
from measure_residence import measure_residence
from plot_residence import plot_residence
from run_chain import run_chain
from time_models import time_models

INTERVAL_S, RIDES = 0.1, 0.8
# 17 rides of 1/32 m lead out of a bed of 0.5 m, whose far wall belongs to it
MEAN_S = INTERVAL_S * 17 / RIDES


@pytest.fixture(scope="module")
def belt(tmp_path_factory):
    """Particles that ride on a belt, 0.5 m long, at 0.25 m/s, and rest in some frames."""
    folder, rng = tmp_path_factory.mktemp("belt"), np.random.default_rng(3)
    n_frames, number = 400, 1200
    start = np.sort(rng.integers(0, n_frames, number))
    ride = rng.random((n_frames, number)) < RIDES
    frame = np.arange(n_frames)[:, None]
    x = np.cumsum(ride / 32 * (frame > start), axis=0)
    x = np.where(frame < start, np.nan, x)
    values = np.stack([x, np.where(np.isnan(x), np.nan, 0.05), x * np.nan, x * np.nan], axis=1)
    np.save(folder / "trajectory.npy", values.astype(np.float32))
    about = {
        "times_s": (INTERVAL_S * np.arange(n_frames)).tolist(), "number": number, "width_m": 0.5,
        "height_m": 0.1, "columns": ["x", "z", "vx", "vz"], "complete": False,
        "frame_interval_s": INTERVAL_S,
    }  # fmt: skip
    (folder / "trajectory.json").write_text(json.dumps(about))
    return BedFiles(folder / "trajectory.npy", folder / "trajectory.json", folder / "cells.npz")


def test_a_belt_has_the_residence_time_of_its_length_over_its_speed(belt, tmp_path):
    assign_cells(belt, belt.cells, Division(10, 1), 0.01, "exit")
    windows = Window(5.0, 20.0), Window(20.0, 39.9)
    measure_residence(belt, tmp_path / "r.csv", *windows, lag_s=INTERVAL_S)
    table = pd.read_csv(tmp_path / "r.csv")
    means = table[table["quantity"] == "mean"].set_index("source")
    for source in ("dem", "chain"):
        assert means.loc[source, "value"] == pytest.approx(MEAN_S, rel=0.03)
        assert means.loc[source, "ci_low"] < means.loc[source, "ci_high"]
    # a chain of cells does not know how long a particle was in its cell: it spreads what the belt keeps close
    spread = table[table["quantity"] == "variance"].set_index("source")["value"]
    assert spread["chain"] > 2 * spread["dem"]
    files = FigureFiles(tmp_path / "f.png", tmp_path / "f.pdf", tmp_path / "f.csv", 100)
    plot_residence(tmp_path / "r.csv", files, {"dem": "#222222", "chain": "#ee6677"})
    assert files.png.stat().st_size > 10_000 and len(pd.read_csv(files.csv)) == len(table)


@pytest.mark.parametrize("model", ["static", "dynamic"])
def test_chains_of_a_belt_start_from_who_is_there(belt, tmp_path, model):
    assign_cells(belt, belt.cells, Division(10, 1), 0.01, "exit")
    windows = {"learning": Window(5.0, 20.0), "comparison": Window(20.0, 20.5)}
    file, splits, settings = tmp_path / "t.npz", Splits(0.25, 0.05), ModelSettings("pooled", 5)
    build_transitions(belt, file, model, "pooled", INTERVAL_S, windows["learning"])
    time_models([], belt, [file], tmp_path / "timing.csv", **windows, splits=splits, settings=settings)
    assert (pd.read_csv(tmp_path / "timing.csv")["wall_s"] > 0).all()
    run_chain(
        belt, file, tmp_path / "chain.npz", **windows, splits=splits, batch=Batch(0.1, [0.1, 0.3]),
        settings=settings,
    )  # fmt: skip
    chain = np.load(tmp_path / "chain.npz")
    for name in ("batch_share", "batch_share_monte_carlo"):
        np.testing.assert_allclose(chain[name].sum(axis=1), 1, rtol=1e-9)


def test_a_particle_that_leaves_a_closed_bed_is_named(belt, tmp_path):
    with pytest.raises(DataError, match=r"particle \d+ .*outside the bed"):
        assign_cells(belt, tmp_path / "c.npz", Division(10, 1), 0.01, "refuse")
    assert not (tmp_path / "c.npz").exists()
