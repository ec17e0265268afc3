# SPDX-License-Identifier: GPL-3.0-or-later
"""The cooling of a granular gas of parcels, worked by hand."""

import pytest

from bedchain.studies.verification.parcels import cooling_rate


def test_the_rate_is_that_of_haff_and_the_walls_add_their_share():
    # 0.19 * 2 sqrt(pi) * 0.2 / (pi/4 mm) * (1 - 7/80) / 0.64 / 4; walls 0.38 * 4 / (L sqrt(2 pi)) / 2
    assert cooling_rate(1e9) == pytest.approx(61.14, rel=1e-3)
    assert cooling_rate(0.1) - cooling_rate(1e9) == pytest.approx(3.032, rel=1e-3)
