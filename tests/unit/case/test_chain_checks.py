# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of windows, cells and lags, each refused with key, line and remedy."""

import pytest

from bedchain.case.chain_checks import lag_fits, moments_are_frames
from made.case_text import END, assert_refused, changed_case

MISTAKES = [
    # replaced, by, key named, in the message
    (END, "  end_s: 4.0", "comparison.end_s", "raise time.end_s to 5"),
    ("  start_s: 1.0", "  start_s: 3.5", "learning.end_s", "not after"),
    ("  start_s: 1.0", "  start_s: 1.01", "learning.start_s", "multiple of time.frame_interval_s"),
    ("comparison:\n  start_s: 3.0", "comparison:\n  start_s: 2.0", "comparison.start_s", "at least 3"),
    ("columns: 10", "columns: 91", "cells.columns", "at most 90"),
    ("split_z_m: 0.081", "split_z_m: 0.5", "mixing.split_z_m", "outside the bed"),
    ("split_z_m: 0.081", "split_z_m: 0.081\nchain:\n  lag_s: 0.03", "chain.lag_s", "take 0.025"),
    ("batch_height_m: 0.027", "moments_s: [0.05, 2.05]", "figures.moments_s", "after the end"),
]


@pytest.mark.parametrize(("old", "new", "key", "message"), MISTAKES)
def test_a_mistake_is_refused_with_key_line_and_remedy(tmp_path, old, new, key, message):
    assert_refused(changed_case(tmp_path, (old, new)), key, message)


def test_windows_of_exactly_two_lags_are_taken_in_spite_of_round_off():
    assert 0.15 - 0.1 < 0.05  # in floating point
    assert list(lag_fits(0.025, 0.025, 0.05, 0.1, 0.1, 0.15)) == []
    assert list(moments_are_frames([0.05], 0.025, 0.1, 0.15)) == []
