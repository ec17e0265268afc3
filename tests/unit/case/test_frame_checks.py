# SPDX-License-Identifier: GPL-3.0-or-later
"""A case of frames needs nothing of a simulation, and is checked for what it uses."""

import pytest

from bedchain.case.load import load_case
from bedchain.errors import CaseError, UserError

CASE = """title: frames
frames: {files: "frames_*", step_s: 1.0e-5}
learning: {start_s: 0.1, end_s: 0.5}
comparison: {start_s: 0.5, end_s: 0.9}
cells: {columns: 5, rows: 5}
"""
MEASURED = {
    "frames": {"origin_m": [0, 0, 0]},
    "bed": {"width_m": 0.1, "height_m": 0.2},
    "particles": {"number": 100, "diameter_m": 2e-3},
    "time": {"end_s": 1.0, "frame_interval_s": 0.1},
    "gas": {"model": "none", "cell_size_m": 0.013},
    "chain": {"lag_s": 0.1},
    "mixing": {"split_z_m": 0.05},
    "figures": {"batch_height_m": 0.02, "moments_s": [0.1, 0.2]},
}


def load(tmp_path, text: str = CASE, measured: dict = MEASURED):
    (tmp_path / "case.yaml").write_text(text)
    return load_case(tmp_path / "case.yaml", measure=lambda case, folder: measured)


def test_frames_fill_what_a_case_does_not_give(tmp_path):
    case = load(tmp_path, CASE + "bed: {width_m: 0.12}\n")
    assert (case["bed"]["width_m"], case["bed"]["height_m"]) == (0.12, 0.2) and case["mixing"][
        "split_x_m"
    ] == 0.06
    assert case["gas"]["model"] == "none" and "seed" not in case


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("seed: 15485863\n", "line 6, seed: belongs to a simulation"),
        ("contact: {}\n", "contact: belongs to a simulation"),
        ("gas: {model: none}\n", "gas: belongs to a simulation"),
        ("bed: {width_m: 120}\n", r"frames.length_unit_m: 1 m makes a bed of 120 m x 0.2 m"),
        ("chain: {lag_s: 0.15}\n", "chain.lag_s: 0.15 s is no multiple"),
        ("particles: {diameter_m: 0.05}\n", "cells.columns: 5 cells over 0.1 m are narrower"),
        ("frames: {files: a}\n", "frames"),
    ],
)
def test_what_does_not_fit_is_refused(tmp_path, change, message):
    with pytest.raises(UserError, match=message):
        load(tmp_path, CASE + change)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("end_s: 0.9", "end_s: 1.1", r"1.1 s is after the last frame, at 1 s; take at most 1"),
        ("start_s: 0.1", "start_s: 0.15", r"0.15 s is no multiple of the time between frames \(0.1 s\)"),
        ("start_s: 0.5", "start_s: 0.4", "inside the learning window"),
        ("end_s: 0.9}", "end_s: 0.9, repeats: 2}", "2 repeats of frames, which are there once"),
        ("step_s: 1.0e-5", "step_s: 1.0e-5, across: z", "frames.across: z is the axis of frames.up too"),
        ("step_s: 1.0e-5", "step: 1.0e-5", "frames.step: is an unknown key; did you mean step_s?"),
        ('files: "frames_*", ', "", "frames.files: is missing"),
    ],
)
def test_keys_of_frames_are_checked(tmp_path, old, new, message):
    assert old in CASE
    with pytest.raises(CaseError, match=message):
        load(tmp_path, CASE.replace(old, new))


def test_a_study_that_simulates_refuses_a_case_of_frames(tmp_path):
    (tmp_path / "case.yaml").write_text(CASE)
    with pytest.raises(UserError, match="is a case of frames: this needs a bed that is simulated"):
        load_case(tmp_path / "case.yaml")
