# SPDX-License-Identifier: GPL-3.0-or-later
"""The verification can fail: a solver built from deliberately wrong sources does not pass it."""

import shutil
import subprocess

import pytest

from bedchain.studies.verification.suite import verify
from made import ROOT

# two errors in one build: the law of the suspension has no part in the first
ERRORS = [
    ("dragLaws.C", "150 * solids", "130 * solids", "uniform_bed", "lattice at 0.2 m/s, gidaspow"),
    ("pEqn.C", "== fvc::ddt(voidage) + ", "== ", "suspension", "sinking speed of a uniform suspension"),
]


@pytest.fixture(scope="module")
def wrong_solver(solver, tmp_path_factory):
    folder = tmp_path_factory.mktemp("wrong")
    shutil.copytree(ROOT / "openfoam_case/solver", folder / "solver")
    for file, right, wrong, *_ in ERRORS:
        source = folder / "solver/bedFoam" / file
        text = source.read_text()
        assert text.count(right) == 1
        source.write_text(text.replace(right, wrong))
    # not made fast: that would take twice the processor time of the rest of this file
    fast = folder / "solver/bedFoam/bedFoam.C"
    fast.write_text(f'#pragma GCC optimize("O0")\n{fast.read_text()}')
    # what is not compiled together with a wrong source is as it was
    shutil.copytree(f"{solver}.objects", folder / "bedFoam.objects")
    command = ["sh", str(folder / "solver/build.sh"), str(folder / "bedFoam")]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    return folder / "bedFoam"


@pytest.mark.parametrize(("check", "row"), [error[3:] for error in ERRORS], ids=["drag", "voidage_rate"])
def test_a_wrong_solver_fails(check, row, wrong_solver, tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    table = verify(wrong_solver, tmp_path / "verify", [check])
    failed = table.loc[table["pass"] == "no", "quantity"]
    assert failed.str.startswith(row).any(), table.to_string()
