# SPDX-License-Identifier: GPL-3.0-or-later
"""Gas fields of cases that OpenFOAM itself has meshed and cut, and the picture made of one."""

import shutil

import matplotlib.image
import numpy as np
import pandas as pd
import pytest
import pyvista

from bedchain.dem.gas_field import nearest_gas, read_gas_field
from bedchain.errors import UserError
from bedchain.figures.style import FigureFiles
from bedchain.trajectory.store import BedFiles, read_manifest
from export_bed import link_gas
from made.gas import COLUMNS, HEIGHT, ROWS, WIDTH, voidage_at, write_gas
from made.synthetic_bed import rolling_bed, write_run
from parse_dumps import parse_dumps
from plot_snapshot import plot_snapshot

TIMES = np.round(np.arange(0, 1 + 1e-9, 0.025), 6)


@pytest.fixture(params=["whole", "cut"])
def case(request, tmp_path):
    """OpenFOAM case with a known voidage at 1 s, as one or cut for two ranks."""
    return write_gas(tmp_path / "gas", request.param == "cut")


def test_every_gas_cell_comes_back_in_its_place(case):
    gas = read_gas_field(case, "voidage")
    assert gas.time_s == 1.0
    assert gas.values.size == COLUMNS * ROWS
    np.testing.assert_allclose(gas.values, voidage_at(gas.x_m, gas.z_m), atol=1e-6)
    assert len(set(zip(gas.x_m.round(6), gas.z_m.round(6), strict=True))) == COLUMNS * ROWS


def test_reading_leaves_the_case_as_it_is(case):
    before = sorted(case.rglob("*"))
    read_gas_field(case, "voidage")
    assert sorted(case.rglob("*")) == before


def test_a_viewer_reads_the_exported_gas(case, tmp_path):
    for _ in range(2):  # an export may be made again
        link_gas(case, tmp_path / "export")
    reader = pyvista.POpenFOAMReader(str(tmp_path / "export" / "gas.foam"))
    reader.case_type = "decomposed" if list(case.glob("processor*")) else "reconstructed"
    reader.set_active_time_value(1.0)
    mesh = reader.read()["internalMesh"]
    x, _, z = mesh.cell_centers().points.T
    assert mesh.n_cells == COLUMNS * ROWS
    np.testing.assert_allclose(mesh.cell_data["voidage"], voidage_at(x, z), atol=1e-6)


def test_missing_field_is_refused(case):
    with pytest.raises(UserError, match="no field pressure"):
        read_gas_field(case, "pressure")


def test_snapshot_shows_particles_and_gas_of_one_moment(case, tmp_path):
    dem = write_run(tmp_path, rolling_bed(300, WIDTH, 0.1, TIMES), TIMES, WIDTH, HEIGHT)
    with pytest.raises(UserError, match="no segment has the gas field voidage"):
        nearest_gas(read_manifest(dem), tmp_path, "voidage", 0.2)
    shutil.copytree(case, tmp_path / "dem" / "a1b2c3" / "segment_0002" / "gas")
    parse_dumps(dem, tmp_path / "t.npy", tmp_path / "t.json", WIDTH, HEIGHT, progress=False)
    png, pdf, csv = (tmp_path / f"snapshot.{form}" for form in ("png", "pdf", "csv"))
    bed = BedFiles(tmp_path / "t.npy", tmp_path / "t.json")
    plot_snapshot(dem, bed, FigureFiles(png, pdf, csv, 80), 0.2, 1e-3, "cividis")
    picture = matplotlib.image.imread(png)[..., :3]
    # the voidage fills a good part of the page with blue, the particles leave less ink
    assert ((picture[..., 2] - picture[..., 0]) > 0.1).mean() > 0.05
    assert pdf.read_bytes().startswith(b"%PDF")
    table = pd.read_csv(csv).groupby("part").size()
    assert (table["particle"], table["gas_cell"]) == (300, COLUMNS * ROWS)
