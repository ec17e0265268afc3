# SPDX-License-Identifier: GPL-3.0-or-later
"""The stage that imports frames: what it leaves behind and says."""

import logging

import numpy as np
import pandas as pd

from bedchain.array_files import map_npy
from bedchain.dem.series import read_series
from bedchain.meter import forget_peak, peak_memory_mb
from bedchain.trajectory.imported import Targets
from import_frames import Box, Tables, bed_series, import_frames
from made.forms import STEP_S, moving, text_frame, write_form

SECTION = {
    "files": "*.dump", "step_s": STEP_S, "length_unit_m": 1.0, "time_unit_s": 1.0, "across": "x", "up": "z",
    "keep_depth": False, "without_ids": "refuse", "origin_m": [-0.05, 0.0, -0.02],
}  # fmt: skip


def test_frames_are_stored_with_their_series(tmp_path, caplog):
    series = moving()
    write_form("text", tmp_path / "in", series)
    targets = Targets(*(tmp_path / name for name in ("trajectory.npy", "trajectory.json", "particles.npz")))
    tables = Tables(*(tmp_path / f"{name}.csv" for name in ("bed_series", "motion")))
    with caplog.at_level(logging.INFO, "bedchain"):
        import_frames(SECTION, tmp_path / "in", Box(0.1, 0.2, "refuse"), targets, tables, progress=False)
    heights = read_series(tables.bed_series)["mean_height_m"]
    np.testing.assert_allclose(heights, series.positions[:, :, 2].mean(axis=1) + 0.02, rtol=1e-5)
    assert len(pd.read_csv(tables.motion)) == 5
    assert "6 frames of 20 particles" in caplog.text


def test_periodic_sides_are_named_and_particles_put_back(tmp_path, caplog):
    series = moving()
    series.positions[2, 4, 0] += 0.1  # of the box, which is as wide as the bed
    for frame in range(6):
        (tmp_path / f"f{frame}.dump").write_text(text_frame(series, frame, flags="pp ff pp"))
    targets = Targets(*(tmp_path / name for name in ("trajectory.npy", "trajectory.json", "particles.npz")))
    tables = Tables(*(tmp_path / f"{name}.csv" for name in ("bed_series", "motion")))
    with caplog.at_level(logging.INFO, "bedchain"):
        import_frames(SECTION, tmp_path, Box(0.1, 0.25, "refuse"), targets, tables, progress=False)
    place = np.load(targets.trajectory)[2, 0, np.argsort(np.argsort(series.ids))[4]]
    assert place == np.float32(series.positions[2, 4, 0] - 0.1 + 0.05)
    assert "periodic along x, each 0.1 m: who leaves at one side" in caplog.text
    assert "periodic along z, each 0.2 m, and the bed is not as long" in caplog.text


def test_a_series_of_a_large_store_needs_the_memory_of_a_few_frames(tmp_path):
    frames = 600
    shape = (frames, 4, 50_000)
    file = np.lib.format.open_memmap(tmp_path / "large.npy", "w+", np.float32, shape)  # 0.5 GB of zeros
    file[-1, 1] = 0.3
    file._mmap.close()
    assert forget_peak(), "this system does not tell the peak"
    before_mb = peak_memory_mb()
    series = bed_series(map_npy(tmp_path / "large.npy"), np.arange(frames) * 0.1)
    assert peak_memory_mb() < before_mb + 100
    assert series["mean_height_m"].iloc[-1] == np.float32(0.3)
