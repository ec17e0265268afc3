# SPDX-License-Identifier: GPL-3.0-or-later
"""Dominant frequency of made-up series."""

import numpy as np
import pytest

from bedchain.measures.spectrum import dominant_frequency

TIMES = 0.005 * np.arange(1, 2001)


@pytest.mark.parametrize("frequency", [0.8, 2.0, 6.4])
def test_a_sine_in_noise_has_its_frequency_within_the_resolution(frequency):
    noise = np.random.default_rng(5).normal(size=len(TIMES))
    peak = dominant_frequency(TIMES, 100 + np.sin(2 * np.pi * frequency * TIMES) + 0.5 * noise, 2.5)
    assert peak.resolution_hz == pytest.approx(0.4)
    assert abs(peak.frequency_hz - frequency) <= peak.resolution_hz / 2 + 1e-9
    assert 0.6 < peak.share_1 < 0.95


def test_a_drift_slower_than_a_piece_is_no_peak():
    peak = dominant_frequency(TIMES, TIMES + 0.5 * np.sin(2 * np.pi * 4 * TIMES), 2.5)
    assert peak.frequency_hz == pytest.approx(4.0)


@pytest.mark.parametrize(
    ("times", "values"),
    [([], []), (TIMES[:100], TIMES[:100]), (TIMES, np.ones(len(TIMES))), (np.delete(TIMES, 7), TIMES[1:])],
)
def test_a_series_that_is_short_still_or_has_gaps_has_no_peak(times, values):
    assert np.isnan(dominant_frequency(times, values, 2.5)).all()
