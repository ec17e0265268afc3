# SPDX-License-Identifier: GPL-3.0-or-later
"""A bed on more ranks: who can share it, the fullest slab, pairs across borders, and what is left to gain."""

import numpy as np
import pytest

from bedchain.case.load import load_case
from bedchain.studies.cost.machine_speed import Speed
from bedchain.studies.cost.more_ranks import ACROSS, fullest_slab, more_ranks, ranks_that_share
from made import ROOT

HERE = Speed(1.0, 1.0, 1.0, 1.0, "made up")


@pytest.fixture(scope="module")
def case():
    return load_case(ROOT / "cases" / "paper" / "case.yaml")


def test_ranks_share_the_gas_cells_evenly(case):
    assert ranks_that_share(case) == [1, 2, 3, 6, 9, 27, 54]


def test_the_fullest_slab_by_hand():
    x_m = np.array([[0.1, 0.2, 0.3, 0.9], [0.1, 0.6, 0.7, 1.0]])
    assert fullest_slab(x_m, 1.0, 1) == 1
    assert fullest_slab(x_m, 1.0, 2) == (3 + 3) / 2 / 2
    assert fullest_slab(x_m, 1.0, 4) == (2 + 2) / 2 / 1


def test_pairs_across_borders_are_those_of_random_centres():
    rng = np.random.default_rng(1)
    reach, width, borders = 0.05, 1.0, 4
    x, z = rng.random((2, 4000))
    one, other = np.triu_indices(4000, 1)
    near = np.hypot(x[one] - x[other], z[one] - z[other]) < reach
    slab = np.floor(x / width * (borders + 1))
    share = (slab[one] != slab[other])[near].mean()
    assert share == pytest.approx(ACROSS * reach * borders / width, rel=0.05)


def test_twice_the_ranks_take_more_than_half_the_time(case):
    even = more_ranks(case, HERE)
    assert even["speedup_1"].iloc[0] == 1 and even["speedup_1"].is_monotonic_increasing
    assert (even["speedup_1"] <= even["ranks"]).all()
    crowded = np.full((3, 1000), 0.01)
    crowded[:, ::2] = np.linspace(0, 0.26, 500)
    slower = more_ranks(case, HERE, crowded)
    assert (slower["wall_s"].iloc[1:] > even["wall_s"].iloc[1:]).all()
    assert slower["wall_s"].iloc[0] == even["wall_s"].iloc[0]
