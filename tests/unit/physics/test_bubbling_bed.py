# SPDX-License-Identifier: GPL-3.0-or-later
"""The bed by the two-phase model against the mean height of three simulated beds, with nothing fitted."""

from dataclasses import replace

import numpy as np
import pytest

from bedchain.case.load import load_case
from bedchain.case.scene import scene_of
from bedchain.physics.bubbling_bed import MINIMUM_VOIDAGE, bubbling_bed
from bedchain.physics.two_phase import RegimeError
from made import ROOT

# mean height of the particles: by the model, and of the DEM over its comparison window [m]
BEDS = {"paper": (0.196, 0.204), "short": (0.0603, 0.0634), "mueller": (0.0236, 0.0240)}


def scene(bed):
    return scene_of(load_case(ROOT / "cases" / bed / "case.yaml"))


@pytest.mark.parametrize("bed", BEDS)
def test_mean_height_of_the_simulated_beds(bed):
    expected = bubbling_bed(scene(bed))
    model, dem = BEDS[bed]
    assert expected.regime == "slow"
    assert expected.mean_height == pytest.approx(model, rel=3e-3)
    assert expected.mean_height == pytest.approx(dem, rel=0.05)


def test_paper_bed():
    expected = bubbling_bed(scene("paper"))
    assert expected.share_below(0.25) == pytest.approx(0.639, abs=6e-4)
    assert expected.share_below(0) == 0
    assert expected.share_below(expected.bed_height) == pytest.approx(1, abs=1e-6)
    # all particles are between the distributor and the surface
    solids = np.trapezoid(1 - expected.voidage(), expected.height)
    assert solids == pytest.approx((1 - MINIMUM_VOIDAGE) * expected.minimum_height, rel=1e-6)
    assert 1 < expected.circulation_time < 10


@pytest.mark.parametrize(
    ("changed", "regime"),
    [
        ({"velocity": 0.5}, "fixed bed"),
        ({"velocity": 8.0}, "transport"),
        ({"velocity": 4.0}, "turbulent"),
        ({"width": 0.1}, "slugging"),
        ({"gas": False}, "no gas"),
    ],
)
def test_other_regimes_are_refused_by_name(changed, regime):
    with pytest.raises(RegimeError, match=f"in this regime, {regime}: ") as caught:
        bubbling_bed(replace(scene("paper"), **changed))
    assert caught.value.regime == regime
