# SPDX-License-Identifier: GPL-3.0-or-later
"""Static mixers of two components."""

import pytest

from bedchain.chains.networks.mixer import loaded, static_mixer
from bedchain.chains.networks.page import PageChain


@pytest.fixture(scope="module")
def mixers():
    """One that is loaded from the top, one from the bottom."""
    networks = [static_mixer(10, 1, 10, 0.35, 0.25, 0.0), static_mixer(10, 1, 10, 0.3, 0.3, 0.0)]
    starts = [loaded(10, 1, "top", 0.5), loaded(10, 1, "bottom", 0.5)]
    return {
        name: PageChain(name, *pair, {})
        for name, pair in zip("ab", zip(networks, starts, strict=True), strict=True)
    }
