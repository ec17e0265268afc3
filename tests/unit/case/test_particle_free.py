# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases without particles are named, all others pass."""

import pytest

from bedchain.case.particle_free import particle_free, require_particles
from bedchain.errors import UserError
from made import ROOT


@pytest.mark.parametrize(
    ("case", "kind"),
    [
        ({"network": {}}, "a network"),
        ({"gas": {"model": "two_fluid"}}, "a bed of two fluids"),
        ({"gas": {"model": "coupled"}}, ""),
        ({"gas": "coupled"}, ""),
    ],
)
def test_kinds_of_cases(case, kind):
    assert particle_free(case) == kind


def test_a_network_is_refused_where_particles_are_needed_with_what_it_has():
    with pytest.raises(UserError, match=r"static_mixer is a network.*results/static_mixer/figures"):
        require_particles("static_mixer", ROOT / "cases")
    require_particles("short", ROOT / "cases")
    require_particles("short-fast", ROOT / "cases")
