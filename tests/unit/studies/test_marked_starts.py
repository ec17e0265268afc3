# SPDX-License-Identifier: GPL-3.0-or-later
"""Windows of the protocol, and starts in them."""

import numpy as np
import pytest

from bedchain.errors import UserError
from bedchain.studies.marked_starts import blocks_of, split, starts_in, steps_outside
from made.frames import INTERVAL_S


def test_paper_windows_are_those_of_the_protocol():
    # frames 400 to 600 are 10 to 15 s
    fit, validation = split(slice(400, 601))
    assert (fit.start * INTERVAL_S, (fit.stop - 1) * INTERVAL_S) == pytest.approx((10.0, 13.5))
    assert (validation.start * INTERVAL_S, (validation.stop - 1) * INTERVAL_S) == pytest.approx((13.5, 15.0))


def test_windows_too_short_to_split_are_refused():
    with pytest.raises(UserError, match="holds 5 frames, too few"):
        split(slice(0, 5))


def test_starts_are_apart_and_followed_to_the_end():
    part = slice(100, 181)
    starts = starts_in(part, 12)
    frames = [start.frame for start in starts]
    assert frames[0] == 100 and min(np.diff(frames)) >= 12 and frames[-1] <= 140
    assert {start.last for start in starts} == {180} and [start.number for start in starts] == [0, 1, 2, 3]
    assert len(starts_in(part, 1)) == 5
    assert [start.frame for start in starts_in(part, 1000)] == [100]


def test_blocks_cover_the_window_and_share_their_ends():
    blocks = blocks_of(slice(400, 601))
    assert [(block.start, block.stop - 1) for block in blocks] == [
        (400, 440), (440, 480), (480, 520), (520, 560), (560, 600)
    ]  # fmt: skip
    with pytest.raises(UserError, match="holds 10 frames, too few to leave each of 5 blocks out"):
        blocks_of(slice(0, 10))


def test_steps_that_touch_a_left_out_block_do_not_count():
    weights = steps_outside(slice(4, 9), slice(0, 15), 2)
    # frames 5 to 7 are inside the block
    naive = [not any(frame in (5, 6, 7) for frame in range(start, start + 3)) for start in range(13)]
    assert weights.tolist() == naive
