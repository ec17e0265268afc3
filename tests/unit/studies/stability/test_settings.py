# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings chosen by group."""

import pytest

from bedchain.errors import UserError
from bedchain.studies.stability.settings import StabilitySetting, chosen
from bedchain.studies.stability.theory import Limit


def setting(name, run, group="made up", inputs="1", **more):
    """A setting that does what it is told."""
    return StabilitySetting(group, name, {"x_1": 1.0}, Limit("x [1]", 2.0, "x < 2", 1.0), run, inputs, **more)


def test_settings_are_chosen_with_what_they_are_compared_with():
    settings = [
        setting("base", None), setting("other", None, reduced=True, needs="base"),
        setting("alone", None, group="second", reduced=True), setting("long", None),
    ]  # fmt: skip
    assert [item.name for item in chosen(settings, [], True)] == ["base", "other", "alone"]
    assert [item.name for item in chosen(settings, ["second"], False)] == ["alone"]
    with pytest.raises(UserError, match="no group third: take one of made up, second"):
        chosen(settings, ["third"], False)
