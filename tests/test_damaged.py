# SPDX-License-Identifier: GPL-3.0-or-later
"""A few damaged forms of each file that the program reads; many more in tests/long."""

import pytest

from made.damaged import TARGETS, try_damaged

TIMES = 12  # of each file [1]


@pytest.mark.parametrize("name", TARGETS)
def test_damaged_file_is_read_or_refused_by_a_sentence(tmp_path, name):
    (folder := tmp_path / "files").mkdir()
    try_damaged(TARGETS[name], name, TIMES, folder)
