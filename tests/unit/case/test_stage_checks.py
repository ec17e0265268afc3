# SPDX-License-Identifier: GPL-3.0-or-later
"""What a later stage would refuse after hours is refused when the case is read (issue 18, kind 7)."""

import subprocess
import sys

import pytest

from bedchain.case.load import load_case
from bedchain.case.schema import load_schema, schema_keys
from bedchain.case.stage_checks import COLOURS, MAPS, USUAL_MAPS
from bedchain.errors import CaseError
from made import ROOT
from made.case_text import END, changed_case

SPLIT, FIGURES = "split_z_m: 0.081", "  batch_height_m: 0.027\n"
MISTAKES = [
    # replaced, by, key named, in the message
    (FIGURES, FIGURES + "  dem_colour: blurple\n", "figures.dem_colour", "'blurple' is no colour"),
    (FIGURES, FIGURES + "  left_colour: C\n", "figures.left_colour", "take one such as '#4477aa' or teal"),
    (FIGURES, FIGURES + "  snapshot_colour_map: rainbo\n", "figures.snapshot_colour_map", "is no colour map"),
    (FIGURES, FIGURES + "  moments_s: [0.3, 0.1]\n", "figures.moments_s", "do not rise; take [0.1, 0.3]"),
    (FIGURES, FIGURES + "  moments_s: [0.1, 0.1]\n", "figures.moments_s", "do not rise; take [0.1]"),
    (SPLIT, SPLIT + "\ndiscussion:\n  lags_s: [0.03, 0.3]", "discussion.lags_s", "none of 0.03, 0.3 s"),
    (SPLIT, SPLIT + "\ndiscussion:\n  lags_s: [5]", "discussion.lags_s", "take [0.025], or more"),
    (SPLIT, SPLIT + "\nchain: {lag_s: 0.025, models: [velocity_class], velocity_class: {earlier_s: 0.03}}",
     "chain.velocity_class.earlier_s", "no multiple of time.frame_interval_s (0.025 s); take 0.025"),
    (SPLIT, SPLIT + "\nchain: {lag_s: 0.025, models: [velocity_class], velocity_class: {earlier_s: 0.125}}",
     "chain.velocity_class.earlier_s", "take at most 0.1"),
    (SPLIT, SPLIT + "\nchain: {lag_s: 0.025, models: [recurrence], recurrence: {separation_s: 1}}",
     "chain.recurrence.separation_s", "take at most 0.9875"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "key", "message"), MISTAKES)
def test_what_a_later_stage_refuses_is_refused_at_once(tmp_path, old, new, key, message):
    with pytest.raises(CaseError) as caught:
        load_case(changed_case(tmp_path, (old, new)))
    words = [f"{item.wrong}; {item.remedy}" for item in caught.value.problems if item.key == key]
    assert any(message in text for text in words), caught.value


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (FIGURES, FIGURES + "  dem_colour: tab:blue\n  distribution_colour_map: viridis\n"),
        (FIGURES, FIGURES + "  dem_colour: xkcd:sky blue\n  left_colour: C1\n"),
        (SPLIT, SPLIT + "\ndiscussion:\n  lags_s: [0.03, 0.1]"),
        (SPLIT, SPLIT + "\nchain: {models: [jump]}\ndiscussion:\n  lags_s: [0.03]"),
        (SPLIT, SPLIT + "\nchain: {lag_s: 0.025, models: [recurrence], recurrence: {separation_s: 0.9875}}"),
        (
            SPLIT,
            SPLIT + "\nchain: {lag_s: 0.025, models: [velocity_class], velocity_class: {earlier_s: 0.1}}",
        ),
        (SPLIT, SPLIT + "\nchain: {lag_s: 0.075}"),  # between its steps a chain moves by shorter lags
        (SPLIT, SPLIT + "\nchain: {lag_s: auto}"),
        (END, END + "\n  dem_step_s: 1e-5"),
    ],
)
def test_what_fits_is_taken(tmp_path, old, new):
    load_case(changed_case(tmp_path, (old, new)))


def test_default_lags_of_the_discussion_need_not_fit(tmp_path):
    lags = (END, "  end_s: 5.0\n  frame_interval_s: 0.2\n  segment_s: 0.2")
    chain = (SPLIT, SPLIT + "\nchain:\n  lag_s: 0.2")
    load_case(changed_case(tmp_path, lags, chain, (FIGURES, FIGURES + "  moments_s: [0.2]\n")))


def test_every_colour_and_map_is_checked_and_defaults_import_no_matplotlib():
    keys = schema_keys(load_schema())
    assert {key for key in keys if key.endswith("_colour")} == set(COLOURS)
    assert {key for key in keys if key.endswith("_colour_map")} == set(MAPS)
    assert {keys[key]["default"] for key in MAPS} == set(USUAL_MAPS)
    lines = "import sys; from bedchain.case.load import load_case; load_case('cases/short/case.yaml'); "
    command = [sys.executable, "-c", f"sys = __import__('sys'); sys.path.insert(0, 'scripts'); {lines}"
               "sys.exit('matplotlib' in sys.modules)"]  # fmt: skip
    assert subprocess.run(command, cwd=ROOT, check=False).returncode == 0
