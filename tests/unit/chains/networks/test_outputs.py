# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of a network."""

import numpy as np
import pytest

from bedchain.chains.networks import outputs
from bedchain.chains.networks.page import PageChain
from bedchain.chains.networks.riser import Exchange, riser_steps


@pytest.fixture(scope="module")
def riser():
    return PageChain("riser", riser_steps(3, Exchange(0, 0, 0.1, 0.2, 0)), None, {})


def test_residence_rises_to_nearly_all_and_its_rate_is_its_slope(riser):
    table = outputs.residence_table(riser)
    left = table["left_share_1"].to_numpy()
    assert (np.diff(left) >= 0).all() and left[0] == 0 and left[-1] > 0.99
    np.testing.assert_allclose(table["leaving_rate_1_s"].sum(), left[-1])


def test_states_are_declared_and_computed(riser, mixers):
    table = outputs.states_table(riser)
    np.testing.assert_allclose(table["content"], table["declared"])
    closed = outputs.states_table(mixers["a"])
    assert closed["declared"].isna().all() and closed["content"].sum() == pytest.approx(2.5)


def test_pulses_are_at_the_steps_next_to_the_moments(riser):
    table = outputs.pulses_table(riser._replace(moments_s=(0.0, 1.4)))
    assert sorted(set(table["time_s"])) == [0, 1] and table["content"].sum() == pytest.approx(2)


def test_a_path_ends_where_the_particle_leaves(riser):
    path = outputs.path_table(riser, 60, 1)
    assert path["state"].iloc[0] == "core 1" and path["state"].iloc[-1] == "core 3"
    assert len(path) == pytest.approx(4.2, abs=1.5)
