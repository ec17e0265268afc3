# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene of a case."""

import math

import pytest

from bedchain.case.scene import scene_of
from bedchain.errors import UserError

SAME = 1e-9  # relative, of two ways to one root


def test_voidage_of_the_slab_by_hand(scene):
    # discs that cover 82 % of the area, as spheres in a slab of one diameter
    share = 0.82 / (math.pi / 4) * math.pi / 6
    assert scene.voidage == pytest.approx(1 - share, rel=SAME)


def test_particles_lighter_than_the_gas_are_refused(paper):
    paper["particles"]["density_kg_m3"] = 1.0
    with pytest.raises(
        UserError, match=r"particles.density_kg_m3 \(1\) is not above gas.density_kg_m3 \(1.2\)"
    ):
        scene_of(paper)
