# SPDX-License-Identifier: GPL-3.0-or-later
"""Gas fields of cases that OpenFOAM itself has meshed and cut, and the picture made of one."""

import os
import shutil
import subprocess

import matplotlib.image
import numpy as np
import pandas as pd
import pytest
from synthetic_bed import rolling_bed, write_run

from bedchain.errors import UserError
from bedchain.gas_field import nearest_gas, read_gas_field
from bedchain.trajectory import read_manifest
from parse_dumps import parse_dumps
from plot_snapshot import plot_snapshot

WIDTH, HEIGHT = 0.08, 0.20
COLUMNS, ROWS = 8, 20
TIMES = np.round(np.arange(0, 1 + 1e-9, 0.025), 6)
HEADER = "FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n"
FILES = {
    "controlDict": "startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1;"
    " writeControl timeStep; writeInterval 1; writeFormat binary;",
    "fvSchemes": "",
    "fvSolution": "",
    "decomposeParDict": "numberOfSubdomains 2; method simple; simpleCoeffs { n (2 1 1); delta 1e-9; }",
    "blockMeshDict": f"""scale 1;
vertices ((0 -0.0005 0) ({WIDTH} -0.0005 0) ({WIDTH} 0.0005 0) (0 0.0005 0)
    (0 -0.0005 {HEIGHT}) ({WIDTH} -0.0005 {HEIGHT}) ({WIDTH} 0.0005 {HEIGHT}) (0 0.0005 {HEIGHT}));
blocks (hex (0 1 2 3 4 5 6 7) ({COLUMNS} 1 {ROWS}) simpleGrading (1 1 1));
edges ();
boundary (around {{ type wall; faces ((0 3 2 1) (4 5 6 7) (0 4 7 3) (1 2 6 5)); }}
    faces {{ type empty; faces ((0 1 5 4) (3 7 6 2)); }});""",
}


def voidage_at(x, z):
    """A field that is different in every cell."""
    return 0.4 + 5.0 * x + 0.5 * z


@pytest.fixture(params=["whole", "cut"])
def case(request, tmp_path):
    """OpenFOAM case with a known voidage at 1 s, as one or cut for two ranks."""
    folder = tmp_path / "gas"
    for part in ("system", "constant", "0"):
        (folder / part).mkdir(parents=True)
    for name, text in FILES.items():
        (folder / "system" / name).write_text(HEADER.format(kind="dictionary", name=name) + text)
    z, x = np.meshgrid((np.arange(ROWS) + 0.5) * 0.01, (np.arange(COLUMNS) + 0.5) * 0.01, indexing="ij")
    values = " ".join(f"{value:.6f}" for value in voidage_at(x, z).ravel())
    (folder / "0" / "voidage").write_text(
        HEADER.format(kind="volScalarField", name="voidage") + "dimensions [0 0 0 0 0 0 0];\n"
        f"internalField nonuniform List<scalar> {x.size} ({values});\n"
        "boundaryField { around { type zeroGradient; } faces { type empty; } }\n"
    )
    commands = ["blockMesh", *(["decomposePar"] if request.param == "cut" else [])]
    for command in commands:
        environment = os.environ | {"WM_PROJECT_DIR": "/usr/share/openfoam"}
        done = subprocess.run(
            [command], cwd=folder, env=environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stdout + done.stderr
    roots = sorted(folder.glob("processor*")) or [folder]
    for root in roots:
        (root / "0").rename(root / "1")
    return folder


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
    plot_snapshot(dem, tmp_path / "t.npy", tmp_path / "t.json", png, pdf, csv, 0.2, 1e-3, "cividis", 80)
    picture = matplotlib.image.imread(png)[..., :3]
    # the voidage fills a good part of the page with blue, the particles leave less ink
    assert ((picture[..., 2] - picture[..., 0]) > 0.1).mean() > 0.05
    assert pdf.read_bytes().startswith(b"%PDF")
    table = pd.read_csv(csv).groupby("part").size()
    assert (table["particle"], table["gas_cell"]) == (300, COLUMNS * ROWS)
