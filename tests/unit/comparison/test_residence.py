# SPDX-License-Identifier: GPL-3.0-or-later
"""Residence times of a row of tanks whose mean, variance and distribution are known."""

import numpy as np
import pytest

from bedchain.comparison.residence import KINDS, of_chain, of_dem, residence_table
from bedchain.trajectory.frames import Frames
from bedchain.trajectory.grid import OUTSIDE

INTERVAL_S, LEAVE, TANKS = 0.1, 0.2, 3
MEAN_S = INTERVAL_S * TANKS / LEAVE
VARIANCE_S2 = INTERVAL_S**2 * TANKS * (1 - LEAVE) / LEAVE**2


@pytest.fixture(scope="module")
def tanks():
    """Frames of particles that go through tanks in a row, six a frame on average, in the steady state."""
    rng, n_frames = np.random.default_rng(9), 600
    starts = np.repeat(np.arange(-80, n_frames), rng.poisson(6, n_frames + 80))
    ends = starts[:, None] + rng.geometric(LEAVE, (starts.size, TANKS)).cumsum(axis=1)
    frame = np.arange(n_frames)[:, None]
    cells = sum((frame >= ends[:, tank]).astype(np.int32) for tank in range(TANKS))
    cells = np.where((frame < starts) | (cells == TANKS), OUTSIDE, cells).astype(np.int32)
    places = np.where(cells < 0, np.nan, 0.5)
    return Frames(INTERVAL_S * np.arange(n_frames), places, places, cells)


@pytest.mark.parametrize("source", ["dem", "chain"])
def test_bands_hold_the_known_residence_times(tanks, source):
    times = INTERVAL_S * np.arange(60)
    of = of_dem(tanks, times) if source == "dem" else of_chain(tanks, TANKS, 1, 59)
    table = residence_table(source, times, of)
    numbers = table[table["time_s"].isna()].set_index("quantity")
    assert list(numbers.index) == list(KINDS)
    known = {"mean": MEAN_S, "variance": VARIANCE_S2, "throughput": 60, "contents": 90}
    for name, value in known.items():
        low, high = numbers.loc[name, ["ci_low", "ci_high"]]
        assert low < value < high and high - low < 0.5 * value, name
    # contents over throughput are the mean residence time (Danckwerts)
    low, high = numbers.loc["contents_over_throughput", ["ci_low", "ci_high"]]
    assert low < numbers.loc["mean", "value"] < high
    assert numbers.loc["held", "value"] == pytest.approx(0, abs=0.01)
    left = table[table["quantity"] == "left_share"]
    assert left["value"].iloc[0] == 0 and left["value"].is_monotonic_increasing
    rate = table[table["quantity"] == "leaving_rate"]
    assert rate["value"].sum() * INTERVAL_S == pytest.approx(left["value"].iloc[-1])
    assert (np.diff(rate["time_s"]) > 0).all() and rate["time_s"].iloc[0] == INTERVAL_S / 2


def test_the_chain_conserves_exactly(tanks):
    residence = of_chain(tanks, TANKS, 1, 5)(np.ones(5, bool))
    assert residence.numbers["contents_over_throughput"] == pytest.approx(
        residence.numbers["mean"], rel=1e-10
    )
