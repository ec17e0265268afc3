# SPDX-License-Identifier: GPL-3.0-or-later
"""Axial chain of a real bed: its contents are those of the two-phase model, and stay."""

import numpy as np
import pytest

from bedchain.chains.networks.bubbling_wakes import (
    Mechanisms,
    bed_of_case,
    bubbling_wakes,
    dispersion,
    remaining,
)
from bedchain.errors import UserError
from made import ROOT


@pytest.fixture(scope="module")
def bed():
    return bed_of_case(ROOT / "cases" / "paper" / "case.yaml")


@pytest.mark.parametrize("mechanisms", [Mechanisms(True, False), Mechanisms(True, True)])
def test_contents_stay_and_are_the_beds(bed, mechanisms):
    chain = bubbling_wakes(bed, 20, mechanisms)
    np.testing.assert_allclose(chain.contents @ chain.product, chain.contents, rtol=1e-12)
    assert chain.contents.sum() == pytest.approx(bed.minimum_height, rel=1e-4)
    heights = np.array([state.height_m for state in chain.states])
    assert heights @ chain.contents / chain.contents.sum() == pytest.approx(bed.mean_height, rel=2e-3)


def test_a_particle_goes_round_in_about_the_circulation_time(bed):
    chain = bubbling_wakes(bed, 40, Mechanisms(True, False))
    value = chain.modes(1).eigenvalues[0]
    period = 2 * np.pi * chain.step_s / abs(np.angle(value))
    assert period == pytest.approx(bed.circulation_time, rel=0.2)


def test_dispersion_alone_spreads_a_pulse_by_its_coefficient(bed):
    chain = bubbling_wakes(bed, 80, Mechanisms(False, True))
    heights = np.array([state.height_m for state in chain.states])
    start, time = np.eye(80)[40], 0.5
    after = chain.expected(start, round(time / chain.step_s))[-1]
    variance = after @ heights**2 - (after @ heights) ** 2
    coefficient = np.interp(heights[40], bed.height, dispersion(bed))
    assert variance == pytest.approx(2 * coefficient * time, rel=0.1)


def test_groups_start_whole_and_end_at_their_shares(bed):
    chain = bubbling_wakes(bed, 20, Mechanisms(True, True))
    curves = remaining(chain, 0.25, np.array([0.0, 30.0]))
    assert curves[0].tolist() == [1, 1]
    below = bed.share_below(0.25)
    np.testing.assert_allclose(curves[1], [below, 1 - below], atol=0.03)


def test_nothing_that_moves_is_refused(bed):
    with pytest.raises(UserError, match="nothing would move"):
        bubbling_wakes(bed, 20, Mechanisms(False, False))


def test_a_case_without_gas_is_refused():
    with pytest.raises(UserError, match="network"):
        bed_of_case(ROOT / "cases" / "riser" / "case.yaml")
    with pytest.raises(UserError, match="no gas"):
        bed_of_case(ROOT / "cases" / "drum" / "case.yaml")
