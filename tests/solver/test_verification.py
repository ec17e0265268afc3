# SPDX-License-Identifier: GPL-3.0-or-later
"""The solvers against theory: every row of the verification table."""

import matplotlib.image
import pytest

from bedchain.studies.verification.suite import CHECKS, verify
from made import ROOT

# rows that each check asserts; a check that lost some would pass with less
ROWS = {
    "contacts": 14, "settling": 12, "suspension": 2, "uniform_bed": 11, "settled_bed": 12, "fluidization": 3,
    "thickness": 4, "conservation": 6, "convergence": 2,
}  # fmt: skip


@pytest.mark.parametrize("name", CHECKS)
def test_every_row_of_a_check_passes(name, solver, tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    table = verify(solver, tmp_path, [name])
    assert len(table) == ROWS[name]
    wrong = table[table["pass"] != "yes"]
    assert wrong.empty, wrong.to_string()
    assert (tmp_path / "verification.csv").exists()
    pictures = list((tmp_path / "figures").glob("*.png"))
    assert pictures
    for picture in pictures:
        assert matplotlib.image.imread(picture)[..., :3].min() < 0.5, f"{picture} is blank"
