# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of settings, as the issue asked for it."""

from bedchain.case.bed_checks import RAYLEIGH_SHARE_MAX
from bedchain.studies.stability.bed_settings import bed_settings
from bedchain.studies.stability.chain_settings import chain_settings


def test_the_study_has_what_was_asked_for():
    settings = [*chain_settings(), *bed_settings()]
    names = [item.name for item in settings]
    assert len(set(names)) == len(names)
    assert {item.needs for item in settings} - {""} <= set(names)
    shares = [item.limit.share * RAYLEIGH_SHARE_MAX for item in settings if item.group == "dem_step"]
    assert min(shares) < 0.011 and max(shares) > 1.4
    young = {item.values["young_Pa"] for item in settings if item.group == "dem_step"}
    assert min(young) == 1e4 and max(young) == 1e9
    assert {item.values["ranks_1"] for item in settings if item.group == "ranks"} == {1, 2, 4}
    assert {item.values["model"] for item in settings if item.group == "chain steps"} == {
        *("static", "dynamic", "velocity_class", "jump", "recurrence")
    }
    off = [item for item in settings if item.guards != "on"]
    assert all(item.name.removesuffix(", guard off") in names for item in off) and len(off) > 3
