# SPDX-License-Identifier: GPL-3.0-or-later
"""A small drum by LIGGGHTS alone, with no program of OpenFOAM in reach, from particles to mixing curves."""

import json
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from assign_cells import Division, assign_cells
from bedchain.array_files import read_arrays
from bedchain.chains.registry import ModelSettings, load
from bedchain.dem import run
from bedchain.dem.parameter_files import write_parameters
from bedchain.errors import UserError
from bedchain.measures.batch import Batch
from bedchain.measures.mixing import Splits
from bedchain.trajectory.dumps import read_dump
from bedchain.trajectory.frames import Window
from bedchain.trajectory.store import BedFiles, open_trajectory
from build_transitions import build_transitions
from made import ROOT
from parse_dumps import parse_dumps
from run_chain import run_chain

DIAMETER, REVOLUTION, NUMBER, END = 0.06, 1.0, 160, 8.0
SMALL = {
    "title": "small drum for the tests",
    "seed": 10007,
    "bed": {"width_m": DIAMETER, "height_m": DIAMETER},
    "drum": {"revolution_s": REVOLUTION},
    "particles": {"number": NUMBER, "diameter_m": 3e-3, "density_kg_m3": 2500},
    "gas": {"model": "none"},
    "contact": {"young_modulus_Pa": 1e6, "friction_1": 0.8},
    "time": {"dem_step_s": 8e-5, "settle_s": 0.24, "frame_interval_s": 0.04, "segment_s": 2.0, "end_s": END},
    "learning": {"start_s": 1.0, "end_s": 7.0},
    "comparison": {"start_s": 7.0, "end_s": 8.0},
    "chain": {"lag_s": 0.2},
    "cells": {"columns": 4, "rows": 4},
    "mixing": {"split_z_m": 0.015},
    "figures": {"batch_height_m": 0.015, "moments_s": [0.2]},
}
OVERLAP = 0.1 * 3e-3  # with the wall: 0.06 diameters where the avalanche lands, by the softened contacts
# the first step from a restart damps contacts by other velocities, half a step apart: 1e-3 after 500 steps
BORDER = 1e-2
STICK = 0.1  # relative, of the wall layer's velocity before the bed starts to slide


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """Function that writes the small drum's parameters into a new folder."""

    def make(name):
        file = tmp_path_factory.mktemp("drum") / "case.yaml"
        file.write_text(yaml.safe_dump(SMALL), encoding="utf-8")
        write_parameters(file, file.parent / name)
        return file.parent / name

    return make


@pytest.fixture(scope="module")
def no_openfoam(tmp_path_factory):
    """PATH on which LIGGGHTS is the only solver, in the project's folder, with no bedFoam built."""
    programs = tmp_path_factory.mktemp("bin")
    (programs / "liggghts").symlink_to(shutil.which("liggghts"))
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(ROOT)
        patch.setenv("PATH", str(programs))
        patch.setattr(run, "SOLVER", Path("not/built"))
        assert shutil.which("blockMesh") is None
        yield patch


def files_of(folder):
    """Trajectory and cells of the run in a folder."""
    return BedFiles(*(folder / name for name in ("trajectory.npy", "trajectory.json", "cells.npz")))


@pytest.fixture(scope="module")
def drum(small, no_openfoam):
    """The run, with its trajectory and cells."""
    folder = small("run")
    run.run_dem(folder, END, 2.0, 1)
    bed = files_of(folder)
    parse_dumps(folder / "dem.json", bed.trajectory, bed.metadata, DIAMETER, DIAMETER, progress=False)
    assign_cells(bed, bed.cells, Division(4, 4), 3e-3)
    return folder


def test_particles_are_conserved_and_stay_inside(drum):
    manifest = json.loads((drum / "dem.json").read_text())
    assert len(manifest["frames"]) == round(END / 0.04) + 1
    for frame in manifest["frames"]:
        dump = read_dump(drum / frame["file"], manifest["columns"])
        assert sorted(dump.values[:, 0]) == list(range(1, NUMBER + 1))
        x, z = dump.values[:, 1] - DIAMETER / 2, dump.values[:, 2] - DIAMETER / 2
        assert np.hypot(x, z).max() < DIAMETER / 2 - 1.5e-3 + OVERLAP
    series = pd.read_csv(drum / "bed_series.csv")
    assert (series["particles_1"] == NUMBER).all()
    np.testing.assert_allclose(series["time_s"], np.arange(len(series)) * 0.04, atol=1e-9)


def test_the_wall_carries_the_particles_on_it_at_its_own_speed(drum):
    values, _ = open_trajectory(drum / "trajectory.npy", drum / "trajectory.json")
    x, z, vx, vz = values[1]  # 0.04 s after the start: the bed still turns with the drum as one
    x, z = x - DIAMETER / 2, z - DIAMETER / 2
    on_wall = np.hypot(x, z) > DIAMETER / 2 - 2e-3
    # a positive turn about the axis that points into the page: the bottom goes to +x
    along = (vz * x - vx * z)[on_wall] / np.hypot(x, z)[on_wall] ** 2
    assert on_wall.sum() > 10
    assert np.median(along) == pytest.approx(2 * np.pi / REVOLUTION, rel=STICK)


def test_the_surface_inclines_to_the_side_that_the_wall_moves_to(drum):
    series = pd.read_csv(drum / "bed_series.csv").set_index("time_s")["surface_angle_rad"]
    assert abs(series.iloc[0]) < 0.1
    assert 0.1 < series.loc[1.0:].mean() < 1.0
    # the same from the particles: their centroid hangs on that side of the axis
    values, _ = open_trajectory(drum / "trajectory.npy", drum / "trajectory.json")
    last = values[-1].astype(float)
    angle = np.arctan2(last[0].mean() - DIAMETER / 2, DIAMETER / 2 - last[1].mean())
    assert series.iloc[-1] == pytest.approx(angle, rel=1e-5)


@pytest.mark.parametrize("lag", [REVOLUTION, REVOLUTION / 5])
def test_matrix_of_a_revolution_is_stochastic_and_knows_only_cells_in_the_drum(drum, tmp_path, lag):
    window = Window(1.0, 7.0)
    build_transitions(files_of(drum), tmp_path / "static.npz", "static", "pooled", lag, window)
    chain = load(tmp_path / "static.npz")
    P = chain.matrix.toarray()
    assert (P >= 0).all()
    np.testing.assert_allclose(P.sum(axis=1), 1, atol=1e-12)
    cells = np.load(drum / "cells.npz")["cells"]
    never = np.setdiff1d(np.arange(16), cells)
    assert never.size > 0  # such as the upper corners: nothing goes there
    visited = np.setdiff1d(np.arange(16), never)
    assert P[np.ix_(visited, never)].sum() == 0


def test_mixing_curve_tends_to_the_mean(drum, tmp_path):
    bed, learning = files_of(drum), Window(1.0, 5.0)
    build_transitions(bed, tmp_path / "static.npz", "static", "pooled", 0.2, learning)
    run_chain(
        bed, tmp_path / "static.npz", tmp_path / "chain.npz", learning, Window(5.0, 8.0),
        Splits(DIAMETER / 2, 0.015), Batch(0.015, [0.2]), ModelSettings("pooled", 1),
    )  # fmt: skip
    left, right = read_arrays(tmp_path / "chain.npz")["remaining"][:, :2].T
    assert left[0] == right[0] == 1
    # both groups end in one distribution: what of each is on the left becomes the same share
    apart = np.abs(left - (1 - right))
    assert apart[-1] < 0.05 and apart[-1] < apart[len(apart) // 2] < apart[0]


def test_a_run_that_was_stopped_goes_on_where_it_was(small, no_openfoam):
    whole, stopped = small("whole"), small("stopped")
    run.run_dem(whole, 0.24, 0.24, 1)
    run.run_dem(stopped, 0.2, 0.2, 1)
    first = {file: file.stat().st_mtime_ns for file in stopped.glob("dem/*/segment_0001/frame_*")}
    run.run_dem(stopped, 0.24, 0.2, 1)
    assert first and all(file.stat().st_mtime_ns == then for file, then in first.items())
    one, two = (pd.read_csv(folder / "bed_series.csv") for folder in (whole, stopped))
    pd.testing.assert_frame_equal(two[:-1], one[:-1])
    after = one.columns.difference(["kinetic_energy_J"])
    np.testing.assert_allclose(two[after].iloc[-1], one[after].iloc[-1], rtol=BORDER)


def test_without_liggghts_a_drum_says_what_is_missing(small, no_openfoam, tmp_path):
    folder = small("none")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PATH", str(tmp_path))
        with pytest.raises(UserError, match="the program liggghts is not installed"):
            run.run_dem(folder, 0.4, 0.4, 1)
    assert not (folder / "dem.json").exists()


def test_a_box_still_asks_for_bedfoam(no_openfoam, tmp_path):
    write_parameters(ROOT / "cases" / "short" / "case.yaml", tmp_path / "short")
    with pytest.raises(UserError, match="not/built missing"):
        run.run_dem(tmp_path / "short", 0.5, 0.5, 1)
