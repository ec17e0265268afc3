# SPDX-License-Identifier: GPL-3.0-or-later
"""A bed from plain arrays: the lines of scripts/README.md, an open bed, three dimensions, and faults."""

import re
import sys
import tomllib

import numpy as np
import pandas as pd
import pytest

from bedchain.errors import DataError
from bedchain.notebook import Bed, residence_in_cells_s, to_deeptime
from made import ROOT
from made.frames import walkers

RUN = walkers(80)
POSITIONS = np.moveaxis(RUN.values[:, :2], 1, 2).astype(float)


def test_the_lines_of_the_readme_run(tmp_path, monkeypatch):
    text = (ROOT / "scripts" / "README.md").read_text(encoding="utf-8")
    lines = re.search(r"<!-- notebook:.*?```python\n(.*?)```", text, re.DOTALL)[1]
    np.savez(tmp_path / "frames.npz", positions=POSITIONS, times_s=RUN.times_s)
    monkeypatch.chdir(tmp_path)
    names: dict = {}
    exec(lines, names)  # noqa: S102
    curves, matrix = names["curves"], names["matrix"]
    assert set(curves["group"]) == {"left", "right", "low", "up"} and len(curves) == 4 * 21
    # a window too short for a band has none
    assert not (curves["low_1"] > curves["high_1"]).any()
    assert np.abs(curves["frames_1"] - curves["chain_1"]).max() < 0.3
    np.testing.assert_allclose(matrix.sum(axis=1), 1)
    np.testing.assert_allclose(names["model"].transition_matrix, matrix.toarray())
    table = pd.read_csv("chain.csv")
    assert len(table) == matrix.nnz and table["probability_1"].sum() == pytest.approx(40)
    assert names["stay_s"].shape == (40,) and (names["stay_s"] >= 0.05).all()


def through_flow(n_frames: int = 400, seed: int = 2) -> tuple[np.ndarray, np.ndarray]:
    """Particles that enter at the bottom, one a frame, rise at their own speeds, and leave at the top."""
    rng = np.random.default_rng(seed)
    speeds = rng.uniform(0.05, 0.15, n_frames)
    height = (np.arange(n_frames)[:, None] - np.arange(n_frames)) * 0.1 * speeds
    height[height < 0] = np.nan
    stay = np.sum((height >= 0) & (height <= 1.0), axis=0) * 0.1
    return np.stack((np.full_like(height, 0.05), height), axis=2), stay


def test_an_open_bed_has_the_residence_time_of_its_particles():
    positions, stay = through_flow()
    box = [(0.0, 0.1), (0.0, 1.0)]
    bed = Bed.from_arrays(positions, 0.1 * np.arange(len(positions)), (1, 20), box, may_leave=True)
    mean, low, high = bed.residence_s(20.0, 39.0)
    assert low < mean < high and mean == pytest.approx(stay[:200].mean(), rel=0.1)
    with pytest.raises(DataError, match="outside the bed"):
        Bed.from_arrays(positions, 0.1 * np.arange(len(positions)), (1, 20), [(0, 0.1), (0.0, 0.001)]).chain(
            0, 39
        )


def test_a_bed_in_three_dimensions_counts_by_layers():
    deep = np.insert(POSITIONS, 1, POSITIONS[:, ::-1, 0], axis=2)
    chain = Bed.from_arrays(deep, RUN.times_s, (3, 3, 2)).chain(0.0, 1.0)
    assert chain.matrix.shape == (18, 18) and np.isfinite(residence_in_cells_s(chain)).any()


def test_arrays_that_do_not_fit_are_refused():
    with pytest.raises(DataError, match=r"positions of shape \(80, 200\)|positions of shape \(81, 200\)"):
        Bed.from_arrays(POSITIONS[:, :, 0], RUN.times_s, (3, 3))
    with pytest.raises(DataError, match="box_m of shape"):
        Bed.from_arrays(POSITIONS, RUN.times_s, (3, 3), [(0, 1)])


def test_package_and_citation_have_one_version():
    version = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    assert f"version: {version}" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")


def test_without_deeptime_its_model_is_refused_by_a_sentence(monkeypatch):
    monkeypatch.setitem(sys.modules, "deeptime.markov.msm", None)
    with pytest.raises(DataError, match="deeptime is not installed"):
        to_deeptime(Bed.from_arrays(POSITIONS, RUN.times_s, (3, 3)).chain(0.0, 1.0))
