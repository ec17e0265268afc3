# SPDX-License-Identifier: GPL-3.0-or-later
"""The peak of the memory rises with what is allocated, and starts again when it is forgotten."""

import os

import numpy as np
import pytest

from bedchain.meter import forget_peak, peak_memory_mb

BLOCK_MB = 200.0


def test_peak_holds_a_block_that_was_freed():
    before = peak_memory_mb()
    block = np.ones(int(BLOCK_MB * 1e6 / 8))
    del block
    assert peak_memory_mb() >= before
    assert peak_memory_mb() > BLOCK_MB
    assert peak_memory_mb(os.getpid()) == pytest.approx(peak_memory_mb(), rel=0.01)
    if forget_peak():
        assert peak_memory_mb() < before + BLOCK_MB / 2


def test_a_process_that_has_ended_has_no_peak():
    with pytest.raises(OSError):
        peak_memory_mb(2**22 + 1)
