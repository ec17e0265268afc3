# SPDX-License-Identifier: GPL-3.0-or-later
"""Bubbles, their share and their exchange of gas against the worked examples of Kunii and Levenspiel."""

import math

import numpy as np
import pytest

from bedchain.physics import two_phase
from bedchain.physics.two_phase import RegimeError

PRINTED = 1e-5  # of numbers given to six digits


def test_mori_wen_of_example_6_2():
    assert two_phase.largest_diameter(0.44, 0.5) == pytest.approx(0.613065, rel=PRINTED)
    assert two_phase.mori_wen_diameter(0.5, 0.44, 0.5, 0.055) == pytest.approx(0.199640, rel=PRINTED)


def test_werther_of_example_6_2():
    heights = np.array([0, 5, 10, 20, 30, 50, 70]) / 100
    expected = np.array([2.004, 2.861, 3.765, 5.687, 7.731, 12.102, 16.771]) / 100
    np.testing.assert_allclose(two_phase.werther_diameter(heights, 0.44), expected, atol=6e-6)


def test_darton_by_hand():
    # 0.54 0.5^0.4 (0.1 + 0.4)^0.8 9.81^-0.2
    expected = math.exp(math.log(0.54) + 1.2 * math.log(0.5) - 0.2 * math.log(9.81))
    assert two_phase.darton_diameter(0.1, 0.5, area=0.01) == pytest.approx(expected)
    assert two_phase.darton_diameter(0.0, 0.5) == 0


def test_exchange_of_example_10_1():
    exchange = two_phase.bubble_emulsion_exchange(0.01, 0.5, np.array([0.05, 0.1, 0.15, 0.2]), 2e-5)
    np.testing.assert_allclose(exchange, [0.9175, 0.3928, 0.2393, 0.1684], atol=6e-5)


def test_reactor_of_example_12_1():
    velocity, minimum, voidage, diameter = 0.1, 0.006, 0.55, 0.04
    bubble = two_phase.bubble_velocity(diameter, velocity - minimum)
    assert two_phase.single_rise_velocity(diameter) == pytest.approx(0.44538, abs=6e-6)
    assert bubble == pytest.approx(0.53938, abs=6e-6)
    regime = two_phase.regime_of(velocity, minimum, voidage, float(bubble))
    assert regime == "vigorous"
    share = two_phase.bubble_share(velocity, minimum, voidage, bubble, regime)
    assert share == pytest.approx(0.18540, abs=6e-6)
    assert two_phase.bubble_cloud_exchange(minimum, diameter, 2e-5) == pytest.approx(3.26329, abs=6e-6)
    assert two_phase.cloud_emulsion_exchange(voidage, diameter, 2e-5) == pytest.approx(1.87310, abs=6e-6)
    assert two_phase.cloud_solids(minimum, voidage, diameter, 0.6) == pytest.approx(0.30390, abs=6e-6)


def test_walls_slow_bubbles_between_an_eighth_and_six_tenths_of_the_width():
    free = two_phase.single_rise_velocity(np.array([0.01, 0.05]))
    slowed = two_phase.single_rise_velocity(np.array([0.01, 0.05]), width=0.1)
    np.testing.assert_allclose(slowed, free * [1, 1.2 * math.exp(-1.49 * 0.5)])
    with pytest.raises(RegimeError, match="slugging: bubbles grow to 0.06 m, 0.60 of the width"):
        two_phase.single_rise_velocity(np.array([0.01, 0.06]), width=0.1)


def test_regimes_by_the_bubble_s_velocity():
    assert two_phase.regime_of(0.9, 0.45, 0.45, 0.9) == "slow"
    assert two_phase.regime_of(0.9, 0.45, 0.45, 1.1) == "intermediate"
    assert two_phase.regime_of(0.9, 0.45, 0.45, 5.1) == "fast"
    with pytest.raises(RegimeError, match="fixed bed") as caught:
        two_phase.regime_of(0.4, 0.45, 0.45, 1.0)
    assert caught.value.regime == "fixed bed"


def test_share_by_regime():
    # u = 0.9, u_mf = 0.45: an excess of 0.45
    def share(bubble, regime):
        return float(two_phase.bubble_share(0.9, 0.45, 0.45, bubble, regime))

    assert share(0.6, "slow") == pytest.approx(0.45 / 1.5)
    assert share(1.0, "intermediate") == pytest.approx(0.45 / 1.45)
    assert share(5.0, "intermediate") == pytest.approx(0.45 / 5.0)
    assert share(3.0, "intermediate") == pytest.approx(0.45 / 3.225)
    assert share(5.85, "fast") == pytest.approx(0.45 / 5.4)
    assert share(9.0, "vigorous") == pytest.approx(0.1)
    with pytest.raises(RegimeError, match="vigorous bubbles would take 1.50 of the bed"):
        share(0.6, "vigorous")


def test_a_slow_bubble_has_no_cloud():
    with pytest.raises(RegimeError, match=r"slow bubbles: .* rises at 0.\d+ of the gas velocity"):
        two_phase.cloud_solids(0.756, 0.45, 0.1, 0.25)
