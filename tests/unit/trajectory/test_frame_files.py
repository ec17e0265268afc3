# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of a pattern in order, and the values of frames in any order."""

import pytest

from bedchain.errors import UserError
from bedchain.trajectory.frame_files import FrameSettings, files_of, loaded
from bedchain.trajectory.survey import survey
from made.forms import STEP_S, moving, write_form

SERIES = moving()


def test_files_are_in_the_order_of_the_numbers_in_their_names(tmp_path):
    for name in ("f_10", "f_9", "f_100"):
        (tmp_path / name).touch()
    assert [file.name for file in files_of("f_*", tmp_path)] == ["f_9", "f_10", "f_100"]
    with pytest.raises(UserError, match=r"no file is named .*g_\*; the folder .* exists"):
        files_of("g_*", tmp_path)


def test_frames_can_be_read_in_any_order(tmp_path):
    pattern = write_form("many_text", tmp_path, SERIES)
    chosen = FrameSettings(pattern, step_s=STEP_S)
    entries = survey(chosen, tmp_path).entries
    mixed = [entries[at] for at in (3, 1, 2, 5)]
    first = [values["x"][0] for _, values in loaded(mixed, chosen)]
    assert first == pytest.approx([SERIES.positions[at, 0, 0] for at in (3, 1, 2, 5)], rel=1e-8)
