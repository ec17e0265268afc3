# SPDX-License-Identifier: GPL-3.0-or-later
"""Time of a simulation over a window that cuts its segments."""

import pytest

from bedchain.errors import UserError
from bedchain.studies.cost.window_time import dem_row

NUMBER, STEP_S, RANKS = 50, 2e-5, 2


def test_dem_time_of_a_window_counts_parts_of_segments():
    segments = [{"start_s": start, "end_s": start + 0.5, "wall_s": 9.0} for start in (0.5, 1.0, 1.5)]
    manifest = {
        "segments": segments, "frame_interval_s": 0.025, "number": NUMBER, "dem_step_s": STEP_S,
        "ranks": RANKS,
    }  # fmt: skip
    # one whole, and half of two
    row = dem_row(manifest, 0.75, 1.75)
    assert row["wall_s"] == pytest.approx(18) and row["cpu_s"] == pytest.approx(RANKS * 18)
    assert row["work"] == NUMBER * 50000
    for segment in segments:
        segment["cpu_s"] = 7.0  # measured, of all ranks
    assert dem_row(manifest, 0.75, 1.75)["cpu_s"] == pytest.approx(14)
    with pytest.raises(UserError, match="segments cover"):
        dem_row(manifest, 2.0, 4.0)
