# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of a case that its frames tell."""

import pytest

from bedchain.errors import UserError
from bedchain.trajectory.frames_of_case import measured_sections, placement_of, settings_of
from made.forms import BOX, STEP_S, moving, write_form

SERIES = moving()
DEFAULTS = {
    "length_unit_m": 1.0, "time_unit_s": 1.0, "across": "x", "up": "z",
    "keep_depth": False, "without_ids": "refuse", "step_s": STEP_S,
}  # fmt: skip


def sections(tmp_path, **case):
    write_form("text", tmp_path, SERIES)
    frames = DEFAULTS | {"files": "*.dump"} | case.pop("frames", {})
    return measured_sections(case | {"frames": frames}, tmp_path, tmp_path / "cache.json")


def test_a_bed_is_where_its_frames_are(tmp_path):
    measured = sections(tmp_path)
    assert measured["bed"] == pytest.approx({"width_m": 0.1, "height_m": 0.2, "thickness_m": 0.01})
    assert measured["frames"]["origin_m"] == pytest.approx(BOX[:, 0]) and measured["frames"]["keep_depth"]
    assert measured["particles"] == {"number": 20, "diameter_m": 0.001}
    assert measured["time"] == {"end_s": 0.05, "frame_interval_s": 0.01}
    assert measured["chain"]["lag_s"] == 0.01 and 0 < measured["mixing"]["split_z_m"] < 0.2


def test_axes_that_point_the_other_way_turn_the_box(tmp_path):
    measured = sections(tmp_path, frames={"up": "-z", "across": "y"})
    assert measured["frames"]["origin_m"] == pytest.approx([0, -0.05, -0.18])
    assert measured["bed"] == pytest.approx({"width_m": 0.01, "height_m": 0.2, "thickness_m": 0.1})


def test_moments_of_the_figures_lie_in_the_comparison(tmp_path):
    measured = sections(tmp_path, comparison={"start_s": 0.02, "end_s": 0.05})
    assert measured["figures"]["moments_s"] == [0.01, 0.02]


def test_a_diameter_is_asked_for_where_there_is_none(tmp_path):
    (tmp_path / "frames.csv").write_text("time,id,x,z\n0,1,0.1,0.2\n1,1,0.2,0.3\n")
    case = {"frames": DEFAULTS | {"files": "frames.csv"}}
    with pytest.raises(UserError, match=r"give particles.diameter_m"):
        measured_sections(case, tmp_path, tmp_path / "cache.json")
    case["particles"] = {"diameter_m": 0.01}
    assert measured_sections(case, tmp_path, tmp_path / "cache.json")["particles"]["diameter_m"] == 0.01


def test_a_section_becomes_settings_and_a_placement():
    section = DEFAULTS | {"files": "a*", "names": ["id", "x"], "columns": {"z": "h"}, "origin_m": [1, 2, 3]}
    settings = settings_of(section)
    assert settings.reading.names == ("id", "x") and settings.reading.columns == {"z": "h"}
    assert placement_of(section, 4, 5, "exit").origin_m == (1, 2, 3)
