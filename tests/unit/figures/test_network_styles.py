# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels and legends of the figures of networks."""

import pandas as pd

from bedchain.figures.network_styles import colours_of, figure_legend, panels_of, with_text
from bedchain.figures.style import figure_style


def test_names_keep_their_colour_in_order_of_appearance():
    assert list(colours_of(["b", "a", "b"])) == ["b", "a"]


def test_six_names_have_six_panels_in_two_rows_and_one_legend():
    with figure_style():
        figure, panels = panels_of(list("abcdef"))
        assert [axes.get_title(loc="left") for axes in panels] == list("abcdef")
        assert sum(axes.get_visible() for axes in figure.axes) == 6
        figure_legend(figure, panels)
        assert not figure.legends
        for axes in panels:
            axes.plot([0, 1], label="same")
        figure_legend(figure, panels)
        assert [text.get_text() for text in figure.legends[0].get_texts()] == ["same"]


def test_empty_texts_stay_texts():
    table = with_text(pd.DataFrame({"zone": [float("nan"), float("nan")]}), "zone")
    assert table["zone"].tolist() == ["", ""]
