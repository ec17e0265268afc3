# SPDX-License-Identifier: GPL-3.0-or-later
"""The table that the checks are gathered in; the checks themselves need the solvers."""

import pandas as pd
import pytest

from bedchain.errors import UserError
from bedchain.studies.verification import suite
from bedchain.studies.verification.rows import Row


def test_rows_of_the_checks_asked_for_are_gathered_and_counted(tmp_path, monkeypatch):
    good, bad = Row("a [1]", 1.0, 1.0, 0.1, "x"), Row("b [1]", 2.0, 1.0, 0.1, "x")
    monkeypatch.setattr(suite, "CHECKS", {"one": lambda *_: [good, bad], "two": lambda *_: [good]})
    (tmp_path / "bedFoam").touch()
    messages = []
    table = suite.verify(tmp_path / "bedFoam", tmp_path / "all", say=messages.append)
    assert table["pass"].tolist() == ["yes", "no", "yes"]
    assert messages[0].startswith("one: 1 of 2 rows pass") and messages[1].startswith("two: 1 of 1 rows pass")
    assert (
        pd.read_csv(tmp_path / "all" / "verification.csv")["quantity"].tolist() == table["quantity"].tolist()
    )
    assert len(suite.verify(tmp_path / "bedFoam", tmp_path / "two", ["two"], messages.append)) == 1


def test_an_unknown_check_names_those_that_exist(tmp_path):
    with pytest.raises(UserError, match="there is no check nothing: take one of contacts, settling"):
        suite.verify(tmp_path, tmp_path, ["nothing"])


def test_a_missing_solver_is_named(tmp_path):
    with pytest.raises(UserError, match="there is no solver .*run snakemake"):
        suite.verify(tmp_path / "bedFoam", tmp_path)
