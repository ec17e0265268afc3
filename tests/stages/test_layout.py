# SPDX-License-Identifier: GPL-3.0-or-later
"""No figure hides text, each in the bed that leaves it the least room; and the check sees what it should."""

import numpy as np
import pandas as pd
import pytest
from matplotlib import pyplot as plt

from bedchain.figures.style import figure_style
from made.drawings import OnlyChecked, layout_flaws
from made.figure_beds import SHAPES, drawings, figure_bed

HARDEST = {
    "fig1_cells": "narrow",
    "fig2_cost": "drum",
    "fig3_static": "drum",
    "fig_distribution_velocity_class": "narrow",
    "fig5b_axial": "narrow",
    "fig_difference": "drum",
    "fig_chapman_kolmogorov": "narrow",
    "fig_timescales": "drum",
    "fig_stationarity": "drum",
    "fig_discussion": "narrow",
    "fig_choice": "drum",
    "fig_modes": "narrow",
    "snapshot": "narrow",
}


@pytest.fixture(scope="module")
def beds(tmp_path_factory):
    """Folders with the data of the beds."""
    names = sorted({*HARDEST.values()})
    return {name: figure_bed(tmp_path_factory.mktemp(name), SHAPES[name]) for name in names}


@pytest.mark.parametrize(("figure", "bed"), HARDEST.items())
def test_no_text_is_cut_off_or_overprinted(beds, tmp_path, figure, bed):
    drawings(beds[bed], SHAPES[bed], tmp_path, OnlyChecked)[figure](figure)
    assert len(pd.read_csv(tmp_path / f"{figure}.csv")) > 0


def drawn(*texts):
    """Flaws of a figure with texts at places of the page."""
    with figure_style():
        figure = plt.figure(figsize=(3, 3), layout="none")
        for x, y, text in [*texts, (0.0, 0.95, "top left"), (0.9, 0.02, "end")]:
            figure.text(x, y, text)
        return layout_flaws(figure)


def test_the_check_sees_text_that_leaves_the_page_or_is_overprinted():
    assert drawn((0.1, 0.1, "here"), (0.1, 0.5, "there")) == []
    assert drawn((0.9, 0.1, "far too long for it")) == ["'far too long for it' leaves the page"]
    assert drawn((0.1, 0.1, "first"), (0.12, 0.1, "second")) == ["'first' and 'second' overprint each other"]


def test_the_check_sees_curves_through_text_and_no_hidden_ticks():
    with figure_style():
        figure, axes = plt.subplots(figsize=(3, 3))
        axes.plot([0, 1], [0, 1])
        axes.set(xlim=(0, 0.01))
        assert layout_flaws(figure) == []
        axes.set(xlim=(0, 1))
        axes.text(0.5, 0.5, "amid", ha="center", va="center")
        assert layout_flaws(figure) == ["a curve crosses 'amid'"]


def test_the_check_sees_error_bars_cut_off_wasted_paper_and_tall_colour_bars():
    with figure_style():
        figure, axes = plt.subplots(figsize=(3, 3))
        axes.errorbar([0, 1], [0, 1], 0.5, label="error")
        assert layout_flaws(figure) == []
        axes.set_ylim(-0.4, 1.6)
        assert layout_flaws(figure) == ["an error bar of 'error' is cut off"]
        figure, axes = plt.subplots(figsize=(3, 3))
        figure.colorbar(axes.pcolormesh(np.eye(3)), ax=axes)
        assert layout_flaws(figure) == []
        axes.set(aspect=0.4, anchor="S")
        (flaw,) = layout_flaws(figure)
        assert flaw.startswith("a colour bar is ") and flaw.endswith(" times as high as the maps")
        figure = plt.figure(figsize=(3, 3), layout="none")
        figure.text(0.1, 0.1, "alone")
        assert [flaw.split(": ")[1] for flaw in layout_flaws(figure)] == ["right", "top"]
