# SPDX-License-Identifier: GPL-3.0-or-later
"""Styles of models: the same in every figure, and different from each other."""

from bedchain.chains.registry import LEARNERS
from bedchain.figures.model_styles import BASELINE, label, model_styles


def test_the_two_chains_of_the_paper_look_the_same_whatever_else_is_drawn():
    alone, beside = model_styles(["dynamic"]), model_styles(["jump", "static", "zzz", "jump"])
    for name in ("static", "dynamic"):
        assert alone[name] == beside[name]
    assert beside[BASELINE] == beside["static"]


def test_no_two_models_share_a_colour_a_marker_or_a_dash():
    styles = [style for name, style in model_styles(LEARNERS).items() if name != BASELINE]
    assert len(styles) == len(LEARNERS)
    for column in zip(*styles, strict=True):
        assert len(set(column)) == len(styles)


def test_labels_are_words():
    assert label("velocity_class") == "velocity class chain"
    assert label(BASELINE) == "static, as in the paper"
