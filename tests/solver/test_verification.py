# SPDX-License-Identifier: GPL-3.0-or-later
"""The solvers against theory: every row of the verification table."""

import matplotlib.image
import pytest

from bedchain.studies.verification.suite import CHECKS, verify
from made import ROOT

# rows that each check asserts; a check that lost some would pass with less
ROWS = {
    "contacts": 14, "settling": 12, "suspension": 2, "uniform_bed": 11, "settled_bed": 12, "fluidization": 3,
    "thickness": 4, "conservation": 6, "convergence": 2, "parcels": 16,
}  # fmt: skip
# of them averages or fits, which have an error of their own
AVERAGES = {"suspension": 1, "settled_bed": 8, "fluidization": 3, "thickness": 4, "parcels": 2}


@pytest.mark.parametrize("name", CHECKS)
def test_every_row_of_a_check_passes(name, solver, tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    table = verify(solver, tmp_path, [name])
    assert len(table) == ROWS[name]
    wrong = table[table["pass"] != "yes"]
    assert wrong.empty, wrong.to_string()
    averages = table[table["error"].notna()]
    assert len(averages) == AVERAGES.get(name, 0)
    wide = averages["error"] >= averages["tolerance"] * averages["reference"]
    assert not wide.any(), averages[wide].to_string()  # a row whose own noise is its tolerance says nothing
    assert (tmp_path / "verification.csv").exists()
    pictures = list((tmp_path / "figures").glob("*.png"))
    assert pictures
    for picture in pictures:
        assert matplotlib.image.imread(picture)[..., :3].min() < 0.5, f"{picture} is blank"
