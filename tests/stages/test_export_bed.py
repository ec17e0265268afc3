# SPDX-License-Identifier: GPL-3.0-or-later
"""What viewers read of a bed, read back: particles, index, dump and densities."""

import re

import numpy as np
import pytest
import pyvista

from bedchain.errors import UserError
from bedchain.trajectory.cell_store import open_cells
from bedchain.trajectory.dumps import read_dump
from export_bed import export_bed
from made.figure_beds import MOMENTS, SHAPES, TIMES, figure_bed


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """Folder of a bed and of its export."""
    results = figure_bed(tmp_path_factory.mktemp("bed"), SHAPES["drum"])
    return results, export_bed(results)


def test_paraview_finds_every_frame_with_its_time(exported):
    results, folder = exported
    reader = pyvista.get_reader(str(folder / "bed.pvd"))
    np.testing.assert_allclose(reader.time_values, TIMES, atol=1e-6)
    reader.set_active_time_value(reader.time_values[7])
    cloud, frame = reader.read()[0], np.load(results / "trajectory.npy", mmap_mode="r")[7]
    np.testing.assert_array_equal(cloud.points[:, [0, 2]].T, frame[:2])
    np.testing.assert_array_equal(cloud["velocity"][:, [0, 2]].T, frame[2:])


def test_the_dump_is_one_that_lammps_viewers_read(exported):
    results, folder = exported
    text = (folder / "frames.dump").read_text()
    frames = re.split(r"(?=ITEM: TIMESTEP)", text)[1:]
    assert len(frames) == len(TIMES)
    (folder.parent / "one.txt").write_text(frames[3])
    dump = read_dump(folder.parent / "one.txt", ["id", "x", "y", "z", "vx", "vy", "vz"])
    frame = np.load(results / "trajectory.npy", mmap_mode="r")[3]
    np.testing.assert_allclose(dump.values[:, [1, 3]].T, frame[:2], rtol=1e-5, atol=1e-9)


def test_densities_stand_in_their_cells(exported):
    results, folder = exported
    image, grid = pyvista.read(folder / "chain_static.vti"), open_cells(results / "cells.npz").grid
    with np.load(results / "chain_static.npz") as chain:
        np.testing.assert_array_equal(image[f"share_{MOMENTS[1]:g}_s"], chain["batch_share"][1])
    np.testing.assert_allclose(image.cell_centers().points[:, [0, 2]], grid.centres_m, rtol=1e-5)


def test_a_case_that_was_not_run_is_said_to_be_so(tmp_path):
    with pytest.raises(UserError, match="has no trajectory"):
        export_bed(tmp_path)
