# SPDX-License-Identifier: GPL-3.0-or-later
"""Stays and their distribution: by hand, by a loop, and with stays that the window cuts off."""

import numpy as np
import pytest

from bedchain.measures.residence import contents_and_feed, left_share, stays


def naive(present):
    """Stays of each particle in a plain loop."""
    rows = []
    for column in present.T:
        start = None
        for frame, here in enumerate(column):
            if here and frame and not column[frame - 1]:
                start = frame
            if start is not None and here and (frame + 1 == len(column) or not column[frame + 1]):
                rows.append((start, frame - start + 1, frame + 1 < len(column)))
                start = None
    return rows


def test_stays_by_hand():
    present = np.array([[1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1]], bool)
    observed = stays(present)
    # the first was there before the window, the last is still there
    assert list(zip(*observed, strict=True)) == [(1, 2, True), (3, 1, False)]
    contents, feed = contents_and_feed(present)
    assert contents.tolist() == [2, 1, 1] and feed.tolist() == [1, 0, 1]


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_stays_agree_with_a_loop(share):
    present = np.random.default_rng(4).random((20, 60)) < share
    assert [tuple(map(int, row)) for row in zip(*stays(present), strict=True)] == naive(present)


def test_the_share_that_left_of_stays_that_are_over_is_counted():
    present = np.zeros((8, 4), bool)
    for particle, frames in enumerate((1, 2, 2, 4)):
        present[1 : 1 + frames, particle] = True
    share = left_share(stays(present), 0.5, np.array([0, 0.5, 1.0, 1.5, 2.0]))
    assert share.tolist() == [0, 0.25, 0.75, 0.75, 1]


def test_stays_that_are_cut_off_do_not_make_the_distribution_shorter():
    rng = np.random.default_rng(5)
    present = np.zeros((60, 4000), bool)
    for particle, start in enumerate(rng.integers(0, 60, 4000)):
        present[start : start + rng.geometric(0.05), particle] = True
    times = np.array([5.0, 10.0, 20.0])
    expected = 1 - 0.95**times
    np.testing.assert_allclose(left_share(stays(present), 1.0, times), expected, atol=0.03)
    observed = stays(present)
    over = observed.of(observed.ended)
    assert left_share(over, 1.0, times)[1] > expected[1] + 0.1  # what leaving them out would give


def test_after_the_longest_stay_that_is_not_over_nothing_is_known():
    present = np.zeros((4, 2), bool)
    present[1:2, 0] = present[1:, 1] = True
    np.testing.assert_array_equal(
        left_share(stays(present), 1.0, np.array([1.0, 3.0, 4.0])), [0.5, 0.5, np.nan]
    )
