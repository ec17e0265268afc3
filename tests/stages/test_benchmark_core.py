# SPDX-License-Identifier: GPL-3.0-or-later

import numpy as np
import pytest

import benchmark_core
from bedchain.trajectory.synthetic import write_cells

GRID = benchmark_core.grid_of((9, 35))


@pytest.fixture(scope="module")
def trajectory(tmp_path_factory):
    path = tmp_path_factory.mktemp("benchmark") / "cells.npy"
    write_cells(path, GRID, 2000, 25, seed=7)
    return path


@pytest.fixture(scope="module")
def places(trajectory):
    path = trajectory.with_name("places.npy")
    write_cells(path, GRID, 2000, 25, seed=7, places=True)
    return path


def test_made_up_places_are_those_of_the_cells(trajectory, places):
    x, z = np.moveaxis(np.load(places), 1, 0)
    # float32 may put a particle on the other side of an edge
    assert (GRID.cell_of(x, z) == np.load(trajectory)).mean() > 0.999


def test_made_up_bed_repeats_by_seed_and_stays_inside(trajectory, tmp_path):
    cells = np.load(trajectory)
    assert cells.shape == (25, 2000) and cells.dtype == np.int32
    assert cells.min() >= 0 and cells.max() < GRID.n_cells
    assert (cells[1:] != cells[:-1]).mean() > 0.1
    write_cells(tmp_path / "again.npy", GRID, 2000, 25, seed=7)
    write_cells(tmp_path / "other.npy", GRID, 2000, 25, seed=8)
    assert (tmp_path / "again.npy").read_bytes() == trajectory.read_bytes()
    assert (tmp_path / "other.npy").read_bytes() != trajectory.read_bytes()


def test_the_methods_compared_make_the_same_matrix(trajectory):
    cells = np.load(trajectory)
    ours, plain, deeptime = (
        benchmark_core.METHODS[name](cells, GRID)().toarray()
        for name in ("bedchain", "scipy coo", "deeptime")
    )
    visited = np.bincount(cells[:-1].ravel(), minlength=GRID.n_cells) > 0
    opened = plain[visited].sum(axis=1) > 0
    assert np.abs(plain - deeptime).max() < 1e-12
    # Ours differs where a rule sends particles back from cells entered only at the end.
    differs = np.abs(ours - plain)[visited][opened].max(axis=1) > 1e-12
    assert differs.sum() <= 2


@pytest.mark.parametrize("method", list(benchmark_core.METHODS))
def test_every_method_is_measured(method, trajectory, places):
    path = places if method.split()[0] in benchmark_core.PLACED else trajectory
    found = benchmark_core.measure(method, path, (9, 35), repeats=1)
    assert found["median_s"] > 0 and found["entries"] > 0
    assert found["peak_rss_mb"] > 10 and found["own_rss_mb"] >= 0


def test_a_task_runs_in_a_fresh_process_and_becomes_a_row(tmp_path):
    task = benchmark_core.Task(
        "static counts and matrix", "bedchain", 300, 8, (9, 35), 2, limit_s=1e-9, limit_mb=1e9
    )
    row = benchmark_core.run_task(task, tmp_path)
    assert (row["met"], row["target"], row["repeats"]) == ("no", "<= 1e-09 s and <= 1e+09 MB", 2)
    assert set(row) == set(benchmark_core.FIELDS)
    assert "| 300 | 9 x 35 |" in benchmark_core.table([row]).splitlines()[2]


def test_ratios_are_told():
    row = {"median_s": 0.1, "cpu_s": 0.1, "own_rss_mb": 50.0, "entries": 10, "particles": 1000}
    rows = [
        row | {"work": "static counts and matrix", "method": "bedchain"},
        row | {"work": "dynamic counts and matrix", "method": "dynamic", "median_s": 1.5, "entries": 200},
        row | {"work": "static counts from disk", "method": "counts"},
        row | {"work": "static counts from disk", "method": "counts", "median_s": 0.9, "particles": 10_000},
    ]
    told = benchmark_core.relative_rows(rows)
    assert "15.0 times the time" in told[0] and "20 times the entries" in told[0]
    assert told[1] == "10 times the particles take 9.0 times the time, 1.0 times that of the processor."
