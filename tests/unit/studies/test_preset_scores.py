# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of the presets: units, blocks of time, and settings that do not go with a bed."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from bedchain.case.chosen import Chosen
from bedchain.case.load import load_case
from bedchain.case.presets import Preset
from bedchain.studies.marked_starts import Start
from bedchain.studies.preset_scores import (
    Realised,
    another_run,
    blocks_of_frames,
    chains_of,
    error_columns,
    learning_window,
)
from bedchain.studies.scores.held_out import HeldOut
from made import ROOT

FRAMES = 41


def held(curves, apart=5):
    """Starts `apart` frames from each other in one run, each followed to the same last frame."""
    last = apart * (len(curves) - 1) + curves.shape[1] - 1
    starts = [Start(0, number, number * apart, last) for number in range(len(curves))]
    run = SimpleNamespace(interval_s=0.1)
    return HeldOut([run], starts, None, curves, [], np.zeros(0, np.int64), np.zeros((len(curves), 0, 1)))


@pytest.fixture
def realised():
    rng = np.random.default_rng(3)
    repeats = 0.5 + 0.02 * rng.normal(size=(3, FRAMES, 4))
    earlier = 0.5 + 0.1 * rng.normal(size=(3, FRAMES, 4))
    return Realised(held(0.5 + 0.1 * rng.normal(size=(5, FRAMES, 4))), repeats, 20.0, earlier)


def test_the_mean_of_all_starts_errs_by_their_spread_and_another_run_by_root_two(realised):
    columns = error_columns(0.5 - realised.held.curves, realised)
    assert columns["over_spread_1"] == pytest.approx(1, abs=0.05)
    assert columns["ci_low_1"] < columns["over_spread_1"] < columns["ci_high_1"]
    assert columns["spread_of_starts_1"] == pytest.approx(0.1, abs=0.01)
    another = another_run(realised)
    assert another["over_spread_1"] == pytest.approx(2**0.5)
    # of realisations 0.1 (the run itself) and 0.02 (three) about their mean
    assert another["noise_floor_1"] == columns["noise_floor_1"] == pytest.approx(0.053, abs=0.01)
    assert columns["over_floor_1"] == columns["single_error_1"] / columns["noise_floor_1"]


def test_the_learning_window_errs_as_another_start_does_unless_the_flow_has_changed(realised):
    assert learning_window(realised)["over_spread_1"] == pytest.approx(2**0.5, abs=0.1)
    changed = replace(realised, earlier=realised.earlier + 0.2)
    assert learning_window(changed)["over_spread_1"] == pytest.approx(6**0.5, abs=0.1)
    pairs = changed.earlier[:, None] - changed.held.curves
    assert learning_window(changed)["error_1"] == pytest.approx(np.sqrt((pairs[:, :, 1:] ** 2).mean()))


def test_starts_of_a_shorter_learning_window_are_compared_while_they_last(realised):
    short = replace(realised, earlier=realised.earlier[:, :21])
    few = realised.repeats[:, :21]
    cut = replace(realised, held=held(realised.held.curves[:, :21]), earlier=short.earlier, repeats=few)
    assert learning_window(short)["over_spread_1"] == pytest.approx(learning_window(cut)["over_spread_1"])


def test_a_single_start_has_no_spread_and_a_run_without_repeats_no_floor(realised):
    alone = Realised(held(realised.held.curves[:1]), np.zeros((0, 0, 4)), 20.0, realised.earlier)
    columns = error_columns(0.5 - alone.held.curves, alone)
    assert np.isnan([columns["over_spread_1"], columns["over_floor_1"], columns["ci_low_1"]]).all()
    assert columns["error_1"] == columns["single_error_1"] > 0
    assert "over_floor_1" not in another_run(alone)


def test_a_window_of_few_correlation_times_has_no_band(realised):
    short = replace(realised, correlation_times=4.0)
    assert np.isnan(error_columns(0.5 - short.held.curves, short)["ci_low_1"])


def test_blocks_are_of_the_same_time_whatever_the_start(realised):
    blocks = blocks_of_frames(realised.held)[:, :, 0]
    assert blocks.shape == (5, FRAMES - 1) and blocks[0, 0] == 0 and blocks[-1, -1] == 4
    for number in range(1, 5):  # a start 5 frames later
        assert (blocks[number, : -5 * number] == blocks[0, 5 * number :]).all()


def test_auto_takes_the_choice_and_a_preset_that_does_not_fit_says_why():
    case = load_case(ROOT / "cases" / "short" / "case.yaml")
    presets = [
        Preset("rule", "auto", "auto", "dynamic"),
        Preset("coarse", 0.03, 0.25, "static"),
        Preset("too long", 0.01, 9.0, "dynamic"),
    ]
    static, dynamic, rule, coarse, too_long = chains_of(case, presets, Chosen(0.2, 8, 32), 0.025)
    assert (static.candidate.columns, static.candidate.rows, static.candidate.lag) == (10, 40, 1)
    assert dynamic.candidate.model == "dynamic"
    assert (rule.candidate.columns, rule.candidate.rows, rule.candidate.lag) == (8, 32, 8)
    # a quarter of the bed's width at most
    assert (coarse.candidate.columns, coarse.candidate.lag) == (4, 10)
    assert too_long.candidate is None and "chain.lag_s" in too_long.problem
