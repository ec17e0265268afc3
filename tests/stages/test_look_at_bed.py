# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of a running bed: the newest whole frame, also of an unfinished segment; nothing disturbed."""

import numpy as np
import pytest

from bedchain.errors import UserError
from look_at_bed import look_at_bed, newest_state
from made.synthetic_bed import rolling_bed, write_run

WIDTH, FILLED, STEP_S = 0.05, 0.04, 2e-5
TIMES = np.round(np.arange(0, 1.01, 0.1), 6)
HEADER = "time_s,pressure_drop_Pa,mean_height_m\n"


@pytest.fixture
def running(tmp_path):
    """A bed in its second segment, which has a half-written frame and a half-written line."""
    write_run(tmp_path, rolling_bed(300, WIDTH, FILLED, TIMES), TIMES, WIDTH, FILLED, dem_step=STEP_S)
    (tmp_path / "dem.json").unlink()
    (tmp_path / "parameters.lig").write_text(
        f"variable dem_step equal {STEP_S}\nvariable depth_walls equal 0\n", encoding="utf-8"
    )
    run = next((tmp_path / "dem").iterdir())
    for number, rows in ((1, "0.1,800,0.02\n0.5,810,0.021\n"), (2, "0.6,790,0.022\n0.7,79")):
        folder = run / f"segment_{number:04d}" / "gas"
        folder.mkdir()
        (folder / "bed_series.csv").write_text(HEADER + rows, encoding="utf-8")
    part = (run / "segment_0002").rename(run / "segment_0002.part")
    whole = (part / "frame_50000.bin").read_bytes()
    (part / "frame_50000.bin").write_bytes(whole[: len(whole) // 2])
    return tmp_path


def test_the_newest_whole_frame_and_the_series_up_to_the_last_whole_line_are_drawn(running):
    before = {file: file.read_bytes() for file in running.rglob("*") if file.is_file()}
    state = look_at_bed(running)
    assert state.time_s == pytest.approx(0.9)
    assert "segment_0002.part" in str(state.frame)
    assert state.series["time_s"].tolist() == [0.1, 0.5, 0.6]
    assert state.gas is None and len(state.x_m) == 300
    after = {file: file.read_bytes() for file in running.rglob("*") if file.is_file()}
    assert len(after.pop(running / "look.png")) > 5000 and after == before


def test_a_bed_that_has_not_begun_is_said_to_be_so(tmp_path):
    with pytest.raises(UserError, match="write_parameters"):
        newest_state(tmp_path)
    (tmp_path / "parameters.lig").write_text("variable depth_walls equal 0\n", encoding="utf-8")
    with pytest.raises(UserError, match="no segment yet"):
        newest_state(tmp_path)
