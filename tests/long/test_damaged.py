# SPDX-License-Identifier: GPL-3.0-or-later
"""Each file that the program reads, in thousands of damaged forms: read or refused, in little memory."""

import pytest

from bedchain.meter import forget_peak, peak_memory_mb
from made.damaged import TARGETS, try_damaged

TIMES = 100_000 // len(TARGETS)  # of each file [1]
MOST_MEMORY_MB = 1000


@pytest.mark.parametrize("name", TARGETS)
def test_damaged_file_is_read_or_refused_by_a_sentence(tmp_path, name):
    (folder := tmp_path / "files").mkdir()
    forget_peak()
    try_damaged(TARGETS[name], name, TIMES, folder)
    assert peak_memory_mb() < MOST_MEMORY_MB
