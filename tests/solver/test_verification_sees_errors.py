# SPDX-License-Identifier: GPL-3.0-or-later
"""The verification can fail: solvers built from deliberately wrong sources do not pass it."""

import shutil
import subprocess

import pytest

from bedchain.studies.verification.suite import verify
from made import ROOT

ERRORS = [
    ("dragLaws.C", "150 * solids", "130 * solids", "uniform_bed", "lattice at 0.2 m/s, gidaspow"),
    ("pEqn.C", "== fvc::ddt(voidage) + ", "== ", "suspension", "sinking speed of a uniform suspension"),
]


@pytest.mark.parametrize(
    ("file", "right", "wrong", "check", "row"), ERRORS, ids=["drag_coefficient", "voidage_rate"]
)
def test_a_wrong_solver_fails(file, right, wrong, check, row, solver, tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    shutil.copytree(ROOT / "openfoam_case/solver", tmp_path / "solver")
    source = tmp_path / "solver/bedFoam" / file
    text = source.read_text()
    assert text.count(right) == 1
    source.write_text(text.replace(right, wrong))
    built = tmp_path / "bedFoam"
    subprocess.run(["sh", str(tmp_path / "solver/build.sh"), str(built)], check=True, capture_output=True)

    table = verify(built, tmp_path / "verify", [check])
    failed = table.loc[table["pass"] == "no", "quantity"]
    assert failed.str.startswith(row).any(), table.to_string()
