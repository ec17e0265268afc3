# SPDX-License-Identifier: GPL-3.0-or-later
"""The solvers against theory: every row of the verification table."""

import matplotlib.image
import pandas as pd
import pytest

from bedchain.studies.verification.suite import CHECKS, verify
from made import ROOT

# rows that each check asserts; a check that lost some would pass with less
ROWS = {
    "contacts": 20, "settling": 12, "suspension": 2, "uniform_bed": 11, "settled_bed": 12, "fluidization": 3,
    "thickness": 4, "conservation": 6, "convergence": 2, "parcels": 16,
}  # fmt: skip
# of them averages or fits, which have an error of their own
AVERAGES = {"contacts": 3, "suspension": 1, "settled_bed": 8, "fluidization": 3, "thickness": 4, "parcels": 2}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Folder of all checks, which share a settled bed."""
    return tmp_path_factory.mktemp("verify")


@pytest.mark.parametrize("name", CHECKS)
def test_every_row_of_a_check_passes(name, solver, folder, monkeypatch):
    monkeypatch.chdir(ROOT)
    drawn = {*folder.glob("figures/*.png")}
    table = verify(solver, folder, [name])
    assert len(table) == ROWS[name]
    wrong = table[table["pass"] != "yes"]
    assert wrong.empty, wrong.to_string()
    averages = table[table["error"].notna()]
    assert len(averages) == AVERAGES.get(name, 0)
    wide = averages["error"] >= averages["tolerance"] * averages["reference"]
    assert not wide.any(), averages[wide].to_string()  # a row whose own noise is its tolerance says nothing
    assert len(pd.read_csv(folder / "verification.csv")) == len(table)
    pictures = {*folder.glob("figures/*.png")} - drawn
    assert pictures
    for picture in pictures:
        assert matplotlib.image.imread(picture)[..., :3].min() < 0.5, f"{picture} is blank"
