# SPDX-License-Identifier: GPL-3.0-or-later
"""The small bed of the comparison."""

import pytest

from made.peers import box


@pytest.fixture
def bed():
    """Three particles in a box of 4 x 12 cells."""
    return box()
