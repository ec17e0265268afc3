# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of the protocol: candidates, windows and starts, runs and repeats, kept results."""

import json
import logging

import numpy as np
import pytest

from bedchain.chains.registry import LEARNERS, learn
from bedchain.errors import UserError
from bedchain.studies.candidates import Candidate, grid_of
from bedchain.studies.marked_starts import split, starts_in
from bedchain.studies.records import record_of, remembered, remove_other_results, stamp
from bedchain.studies.scan import at_frames
from bedchain.studies.scores.search_spaces import SEARCH_SPACES, candidates, scaled
from bedchain.trajectory.grid import Grid
from bedchain.trajectory.realisations import open_realisation, open_repeats, part_of
from bedchain.uncertainty.bands import memory
from made.frames import stirred
from made.persistent_walk import INTERVAL_S, write

GRID = Grid(0.27, 1.05, 27, 105)


@pytest.fixture
def run(tmp_path):
    """A run of 41 frames of 5 particles."""
    values = np.random.default_rng(1).uniform(0, 0.1, (41, 4, 5))
    return open_realisation(
        "the run", write(tmp_path / "run", values, 0.1), tmp_path / "run" / "trajectory.json"
    )


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


def test_memory_is_that_of_a_sloshing_bed(run):
    rng = np.random.default_rng(2)
    phase = np.cumsum(rng.normal(0, 0.3, 400))
    values = np.full((400, 4, 200), 0.05)
    values[:, 0] += 0.02 * np.cos(phase)[:, None] + rng.normal(0, 0.005, (400, 200))
    grid = Grid(0.2, 0.2, 2, 2)
    frames = type(run)("r", values, np.arange(400) * 0.025, 0.2, 0.2).frames(grid, slice(0, 400))
    # a cosine of a random walk forgets with exp(-0.3^2 n / 2): integrated, 2 / 0.045 frames
    assert 10 < memory(frames, 0.05) < 120


def test_all_models_are_tried_with_the_case_itself_among_the_static_ones():
    tried = candidates(LEARNERS, GRID, 2, 1e-3)
    assert set(LEARNERS) <= {one.name for one in tried}
    assert Candidate("static", 27, 105, 2) in tried
    assert len({one.key for one in tried}) == len(tried)
    assert {one.lag for one in tried if one.model == "static"} == {2, 4, 8, 16}


def test_every_option_tried_is_one_of_its_model():
    frames, grid = stirred(3, n_frames=40)
    tried = {(one.model, one.options_text): one for one in candidates(LEARNERS, grid, 1, 1e-3)}
    assert len(tried) > len(LEARNERS)
    for one in tried.values():
        learn(one.model, frames, grid, **one.options)


def test_baselines_compete_as_models_of_their_own():
    names = {one.name for one in candidates(LEARNERS, GRID, 1, 1e-3) if one.model == "recurrence"}
    assert names == {"recurrence", "recurrence_shuffled", "recurrence_replay"}
    assert set(SEARCH_SPACES) <= set(LEARNERS)


def test_cells_finer_than_a_particle_are_left_out():
    for columns, kept in ((50, {50, 100}), (80, {80})):
        tried = candidates(["dynamic"], Grid(0.1, 0.1, columns, columns), 1, 1e-3)
        assert {grid_of(one, GRID).columns for one in tried} == kept


def test_scaled_cells_are_nearly_square():
    grid = scaled(GRID, 2)
    assert (grid.columns, grid.rows) == (14, 52)
    assert grid.cell_width_m == pytest.approx(grid.cell_height_m, rel=0.05)


def test_curves_between_steps_are_straight():
    curves = np.array([[1.0, 1.0], [0.5, 0.8], [0.4, 0.7]])
    found = at_frames(curves, 2, 3)
    assert found[:, 0] == pytest.approx([1, 0.75, 0.5, 0.45])
    assert found.shape == (4, 2)


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
    assert run.frames(Grid(0.1, 0.1, 2, 2), slice(3, 9)).vx_m_s is not None


def test_a_stamp_changes_with_data_and_settings_and_old_results_go(tmp_path):
    file = tmp_path / "data"
    file.write_bytes(b"1")
    first = stamp([file], {"lag": 1})
    assert stamp([file], {"lag": 1}) == first and stamp([file], {"lag": 2}) != first
    file.write_bytes(b"2")
    assert stamp([file], {"lag": 1}) != first
    (remove_other_results(tmp_path / "kept" / first) / "result").write_text("x")
    remove_other_results(tmp_path / "kept" / "new")
    assert [folder.name for folder in (tmp_path / "kept").iterdir()] == ["new"]


def test_a_result_is_made_once_and_a_failure_is_not_kept(tmp_path):
    record, made = record_of(tmp_path / "new", "static 40"), []

    def fail():
        raise UserError("no")

    with pytest.raises(UserError):
        remembered(record, fail)
    assert not record.exists()
    for _ in range(2):
        assert remembered(record, lambda: made.append(1) or {"rms": 0.5}) == {"rms": 0.5}
    assert made == [1]
    assert record_of(tmp_path / "new", "static 41") != record
