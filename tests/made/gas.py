# SPDX-License-Identifier: GPL-3.0-or-later
"""A gas of known voidage on a mesh that OpenFOAM itself has made, and cut for two ranks if so wished."""

import os
import subprocess

import numpy as np

WIDTH, HEIGHT = 0.08, 0.20
COLUMNS, ROWS = 8, 20
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


def voidage_at(x, z, time_s=1.0):
    """A field that is different in every cell, and at every time [s]."""
    return 0.4 + 5.0 * x + 0.5 * z + 0.01 * (time_s - 1.0)


def write_gas(folder, cut=False, time_s=1.0):
    """OpenFOAM case with the voidage of a time [s] and a gas at 1 and 2 m/s; its folder."""
    for part in ("system", "constant", "0"):
        (folder / part).mkdir(parents=True)
    for name, text in FILES.items():
        (folder / "system" / name).write_text(HEADER.format(kind="dictionary", name=name) + text)
    z, x = np.meshgrid((np.arange(ROWS) + 0.5) * 0.01, (np.arange(COLUMNS) + 0.5) * 0.01, indexing="ij")
    values = " ".join(f"{value:.6f}" for value in voidage_at(x, z, time_s).ravel())
    borders = "boundaryField { around { type zeroGradient; } faces { type empty; } }\n"
    (folder / "0" / "voidage").write_text(
        HEADER.format(kind="volScalarField", name="voidage") + "dimensions [0 0 0 0 0 0 0];\n"
        f"internalField nonuniform List<scalar> {x.size} ({values});\n" + borders
    )
    (folder / "0" / "U").write_text(
        HEADER.format(kind="volVectorField", name="U") + "dimensions [0 1 -1 0 0 0 0];\n"
        "internalField uniform (1 0 2);\n" + borders
    )
    for command in ["blockMesh", *(["decomposePar"] if cut else [])]:
        environment = os.environ | {"WM_PROJECT_DIR": "/usr/share/openfoam"}
        done = subprocess.run(
            [command], cwd=folder, env=environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stdout + done.stderr
    for root in sorted(folder.glob("processor*")) or [folder]:
        (root / "0").rename(root / f"{time_s:g}")
    return folder
