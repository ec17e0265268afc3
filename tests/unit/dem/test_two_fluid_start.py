# SPDX-License-Identifier: GPL-3.0-or-later
"""Start of a two-fluid run."""

import numpy as np
import pytest

from bedchain.case.load import load_case
from bedchain.dem.two_fluid_start import field_text, largest_solids, start_solids
from made import ROOT


@pytest.fixture
def case():
    return load_case(ROOT / "cases" / "short" / "case.yaml")


def test_the_bed_at_the_start_holds_all_particles_and_is_uneven(case):
    solids = start_solids(case)
    volume = solids.sum() * 0.005**2 * 1e-3
    assert volume == pytest.approx(9000 * np.pi / 6 * 1e-9, rel=1e-9)
    assert solids.max() == pytest.approx(0.82 * 2 / 3)
    assert np.ptp(solids.sum(axis=0)) > 0.1
    assert solids.max() < largest_solids(case) == 0.605


def test_values_of_cells_as_openfoam_reads_them():
    assert field_text(np.array([[0.5, 0]])) == "internalField nonuniform List<scalar> 2\n(\n0.5\n0\n);\n"
