# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases that can be one of two fluids, and the reason where they cannot."""

import pytest

from bedchain.case.load import load_case
from bedchain.case.two_fluid import two_fluid_case, two_fluid_grids
from bedchain.errors import UserError
from made import ROOT


@pytest.fixture
def case():
    return load_case(ROOT / "cases" / "short" / "case.yaml")


def test_another_cell_gets_a_step_of_the_same_courant_number(case):
    two = two_fluid_case(case, 0.01)
    assert two["gas"]["cell_size_m"] == 0.01 and two["time"]["gas_step_s"] == pytest.approx(1e-3)
    assert two_fluid_case(case) == case
    assert two_fluid_grids(case) == ["10", "5"]


@pytest.mark.parametrize(
    ("section", "key", "value", "said"),
    [
        ("bed", "layers", "many", "a bed of one layer with gas"),
        ("gas", "model", "none", "a bed of one layer with gas"),
        ("gas", "drag_law", "beetstra", "no drag law beetstra: take gas.drag_law gidaspow or wen_yu"),
        ("gas", "cell_size_m", 0.03, "cells of 0.03 m do not divide a bed of 0.1 x 0.4 m"),
    ],
)
def test_what_no_two_fluids_can_be_is_refused(case, section, key, value, said):
    case[section][key] = value
    with pytest.raises(UserError, match=said):
        two_fluid_case(case)
    assert two_fluid_grids(case) == []
