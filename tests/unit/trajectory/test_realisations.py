# SPDX-License-Identifier: GPL-3.0-or-later
"""Realisations of a bed: runs that end early, lack frames or branch off."""

import json
import logging

import numpy as np
import pytest

from bedchain.errors import UserError
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import open_realisation, open_repeats, part_of
from made.frames import INTERVAL_S
from made.persistent_walk import write


@pytest.fixture
def run(tmp_path):
    """A run of 41 frames of 5 particles."""
    values = np.random.default_rng(1).uniform(0, 0.1, (41, 4, 5))
    return open_realisation(
        "the run", write(tmp_path / "run", values, 0.1), tmp_path / "run" / "trajectory.json"
    )


def test_a_run_that_ends_early_is_cut_and_said(run, caplog):
    with caplog.at_level(logging.INFO, "bedchain"):
        part = part_of(run, 0.5, 1.2)
    assert (part.start, part.stop) == (20, 41)
    assert "the run ends at 1 s: 71 % of the window to 1.2 s is used" in caplog.text
    with pytest.raises(UserError, match=r"lacks frames: it ends at 1 s and holds 33% of the window"):
        part_of(run, 0.5, 2.0)


def test_a_run_with_a_missing_frame_is_refused(run, tmp_path):
    file = tmp_path / "run" / "trajectory.json"
    about = json.loads(file.read_text())
    about["times_s"][20:] = [time + INTERVAL_S for time in about["times_s"][20:]]
    file.write_text(json.dumps(about))
    with pytest.raises(UserError, match="repeat 3, .*frames missing: frame 19"):
        open_realisation("repeat 3", file.with_suffix(".npy"), file)


def test_a_repeat_that_branches_off_knows_what_came_before(run, tmp_path):
    grid = Grid(0.1, 0.1, 2, 2)
    branch = np.array(run.values[20:])
    branch[1:] = branch[1:, :, ::-1]
    path = write(tmp_path / "1", branch, 0.1, first=20)
    repeat = open_repeats([path], run)[0]
    at_start, main = repeat.leading_to(grid, 0, 1), run.leading_to(grid, 20, 1)
    for name in ("times_s", "x_m", "z_m", "cells", "vx_m_s", "vz_m_s"):
        np.testing.assert_allclose(getattr(at_start, name), getattr(main, name), rtol=1e-6)
    later = repeat.leading_to(grid, 2, 1)
    np.testing.assert_array_equal(later.x_m, np.concatenate((run.values[18:20, 0], branch[:3, 0])))
    branch[0] = branch[0, :, ::-1]
    other = open_repeats([write(tmp_path / "2", branch, 0.1, first=20)], run)[0]
    assert other.past is None and len(other.leading_to(grid, 0, 1).times_s) == 1


def test_what_is_no_repeat_is_refused(run, tmp_path):
    other = write(tmp_path / "1", np.random.default_rng(3).uniform(0, 0.1, (41, 4, 6)), 0.1)
    with pytest.raises(UserError, match="no repeat of the bed: 6 particles, 5 expected"):
        open_repeats([other], run)
    other.with_suffix(".json").unlink()
    with pytest.raises(UserError, match="trajectory.json is missing"):
        open_repeats([other], run)


def test_missing_velocities_are_said_and_left_to_the_models(run, tmp_path, caplog):
    values = np.array(run.values)
    values[:, 2:] = np.nan
    path = write(tmp_path / "none", values, 0.1)
    with caplog.at_level(logging.INFO, "bedchain"):
        bare = open_realisation("the run", path, path.with_suffix(".json"))
    assert "no velocities" in caplog.text and "differences of positions" in caplog.text
    frames = bare.frames(Grid(0.1, 0.1, 2, 2), slice(3, 9))
    assert frames.vx_m_s is None and frames.vz_m_s is None
    assert (run.frames(Grid(0.1, 0.1, 2, 2), slice(3, 9)).vx_m_s == run.values[3:9, 2]).all()
