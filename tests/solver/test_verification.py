# SPDX-License-Identifier: GPL-3.0-or-later
"""The solvers against theory: every row of the verification table, and that a wrong row is seen."""

import math

import pytest

from bedchain.errors import UserError
from bedchain.studies.verification.rows import Row, table_of
from bedchain.studies.verification.suite import CHECKS, verify
from made import ROOT


@pytest.mark.parametrize("name", CHECKS)
def test_every_row_of_a_check_passes(name, solver, tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    table = verify(solver, tmp_path, [name])
    assert len(table) > 0
    wrong = table[table["pass"] != "yes"]
    assert wrong.empty, wrong.to_string()
    assert (tmp_path / "verification.csv").exists()
    assert list((tmp_path / "figures").glob("*.png"))


@pytest.mark.parametrize(
    ("value", "reference", "tolerance", "passes"),
    [
        (1.009, 1.0, 0.01, True),
        (1.011, 1.0, 0.01, False),
        (-0.98, -1.0, 0.01, False),
        (1e-13, 0.0, 1e-12, True),
        (2e-12, 0.0, 1e-12, False),
        (0.0, 0.0, 0.0, True),
        (math.nan, 1.0, 0.5, False),
    ],
)
def test_tolerance_is_relative_or_absolute_at_zero(value, reference, tolerance, passes):
    row = Row("something [1]", value, reference, tolerance, "made up")
    assert row.passed is passes
    assert table_of([row])["pass"].tolist() == ["yes" if passes else "no"]


def test_an_unknown_check_names_those_that_exist(tmp_path):
    with pytest.raises(UserError, match="there is no check nothing: take one of contacts, settling"):
        verify(tmp_path, tmp_path, ["nothing"])


def test_a_missing_solver_is_told(tmp_path):
    with pytest.raises(UserError, match="there is no solver .*run snakemake"):
        verify(tmp_path / "bedFoam", tmp_path)
