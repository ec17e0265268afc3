# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests of figures need: where their files go, that no page is blank, and that no text is hidden."""

from itertools import combinations

import matplotlib.image
import pandas as pd
from matplotlib.axis import Axis
from matplotlib.collections import QuadMesh
from matplotlib.container import ErrorbarContainer
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from bedchain.figures.style import FigureFiles

DPI = 80
COLOURS = {"dem": "#222222", "static": "#ee6677", "dynamic": "#4477aa"}
# a blank page has one colour; text, axes and data of the smallest figure have far more ink
LEAST_INK = 0.01
# of a page, on each side: more is paper wasted, mostly on maps in the proportions of the bed [inches]
MOST_BLANK_IN = 0.5
# a colour bar over the maps beside it, in height
MOST_OF_MAPS = 1.5
# boxes of text hold some air around the letters [points]; fonts of two machines differ by less
AIR_PT = 1.0


class CheckedFiles(FigureFiles):
    """Files of a figure whose layout is checked when it is saved."""

    def save(self, figure):
        """Refuse text that is cut off or overprinted; save the others."""
        assert not (flaws := layout_flaws(figure)), "\n".join(flaws)
        figure.set_layout_engine("none")  # it was just worked out
        super().save(figure)


class OnlyChecked(CheckedFiles):
    """Files of a figure whose layout is checked, and which is not drawn: that takes most of the time."""

    def save(self, figure):
        """Refuse text that is cut off or overprinted."""
        assert not (flaws := layout_flaws(figure)), "\n".join(flaws)


def layout_flaws(figure: Figure) -> list[str]:
    """Texts off the page, overprinted or crossed by a curve, bars cut off, paper wasted: a line each."""
    figure.draw_without_rendering()
    air = AIR_PT * figure.dpi / 72
    boxes = {text: text.get_window_extent() for text in _visible_texts(figure)}
    page = figure.bbox.padded(air)
    flaws = [
        f"{text.get_text()!r} leaves the page"
        for text, box in boxes.items()
        if not (page.contains(*box.min) and page.contains(*box.max))
    ]  # fmt: skip
    inner = {text: box.padded(-air) for text, box in boxes.items()}
    flaws += [
        f"{first.get_text()!r} and {second.get_text()!r} overprint each other"
        for first, second in combinations(inner, 2)
        if Bbox.intersection(inner[first], inner[second]) is not None
    ]
    for axes in figure.axes:
        for text in set(axes.texts) & inner.keys():
            if text.get_bbox_patch() is None and any(_crosses(line, inner[text]) for line in axes.lines):
                flaws.append(f"a curve crosses {text.get_text()!r}")
        if (legend := axes.get_legend()) and any(
            _crosses(line, legend.get_window_extent()) for line in axes.lines
        ):
            flaws.append("a curve crosses the legend")
    return flaws + _blank_margins(figure) + _cut_bars(figure) + _tall_colour_bars(figure)


def _blank_margins(figure: Figure) -> list[str]:
    """Sides of the page on which nothing is drawn far in."""
    used, (wide, high) = figure.get_tightbbox(), figure.get_size_inches()
    blank = {"left": used.x0, "bottom": used.y0, "right": wide - used.x1, "top": high - used.y1}
    return [f"{inches:.2f} in are blank: {side}" for side, inches in blank.items() if inches > MOST_BLANK_IN]


def _cut_bars(figure: Figure) -> list[str]:
    """Error bars that leave their axes."""
    return [
        f"an error bar of {container.get_label()!r} is cut off"
        for axes in figure.axes
        for container in axes.containers
        if isinstance(container, ErrorbarContainer)
        for bars in container[2]
        for path in bars.get_paths()
        if not all(
            axes.bbox.padded(1).contains(*end) for end in bars.get_transform().transform(path.vertices)
        )
    ]


def _tall_colour_bars(figure: Figure) -> list[str]:
    """Upright colour bars that are much higher than all that has their colours."""
    maps = [axes for axes in figure.axes if any(isinstance(each, QuadMesh) for each in axes.collections)]
    maps = [axes for axes in maps if axes.get_label() != "<colorbar>"]
    if not maps:
        return []
    height = Bbox.union([axes.get_window_extent() for axes in maps]).height
    bars = [axes.get_window_extent() for axes in figure.axes if axes.get_label() == "<colorbar>"]
    return [
        f"a colour bar is {bar.height / height:.1f} times as high as the maps"
        for bar in bars
        if bar.height > max(MOST_OF_MAPS * height, bar.width)
    ]


def _visible_texts(figure: Figure) -> list[Text]:
    """Texts that are drawn: ticks outside the limits of their axis are not."""
    hidden = {
        label
        for axis in figure.findobj(Axis)
        for tick in [*axis.get_major_ticks(), *axis.get_minor_ticks()]
        for label in (tick.label1, tick.label2)
        if not _within(tick.get_loc(), *sorted(axis.get_view_interval()))
    }
    return [
        text
        for text in figure.findobj(Text)
        if text.get_text().strip() and _shown(text, figure) and text not in hidden
    ]


def _within(place: float, low: float, high: float) -> bool:
    slack = 1e-9 * (high - low)
    return low - slack <= place <= high + slack


def _shown(text: Text, figure: Figure) -> bool:
    owner = text.axes
    return text.get_visible() and (
        owner is None or (owner.get_visible() and (owner.axison or text in owner.texts))
    )


def _crosses(line: Line2D, box: Bbox) -> bool:
    return bool(line.get_transform().transform_path(line.get_path()).intersects_bbox(box, filled=False))


def outputs(folder, name):
    """Files of a figure."""
    return CheckedFiles(*(folder / f"{name}.{form}" for form in ("png", "pdf", "csv")), DPI)


def assert_drawn(folder, name):
    """The figure's files are there and complete, with ink on the page; gives its table."""
    files = outputs(folder, name)
    picture = matplotlib.image.imread(files.png)[..., :3]
    assert (picture.min(axis=2) < 0.9).mean() > LEAST_INK
    assert files.pdf.read_bytes().startswith(b"%PDF")
    assert b"%%EOF" in files.pdf.read_bytes()[-64:]
    assert sorted(path.name for path in folder.iterdir() if path.stem == name) == sorted(
        path.name for path in (files.png, files.pdf, files.csv)
    )
    assert not [path for path in folder.iterdir() if path.name.startswith(".")]
    return pd.read_csv(files.csv)
