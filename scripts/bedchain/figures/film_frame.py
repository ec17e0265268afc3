# SPDX-License-Identifier: GPL-3.0-or-later
"""Frame of a film: panels and their axes, drawn once; pictures and the clock, painted into every frame."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from bedchain.figures.film import Canvas
from bedchain.figures.style import close_frame

# sizes beside the panels, in the units of the fonts [inches]; a panel is as high as this
PANEL_IN = 5.6
LEFT_IN, RIGHT_IN, BOTTOM_IN, GAP_IN = 0.62, 0.15, 0.5, 0.18
LEGEND_IN, NAME_IN, CLOCK_IN = 0.18, 0.24, 0.36
NARROWEST_IN = 1.25  # for the name of a panel
CLOCK_POINTS, NAME_POINTS, LEGEND_POINTS = 18, 9, 7
CLOCK_CHARACTERS = "0123456789.- s"
CLOCK_FONT = "DejaVu Sans Mono"


class FilmFrame:
    """Panels side by side, each the bed in pixels of a canvas, with the time above them.

    Parameters
    ----------
    names : list of str
        Above the panels.
    canvas : Canvas
        Whose pictures will be painted.
    """

    def __init__(self, names: list[str], canvas: Canvas) -> None:
        high, wide = canvas.shape
        self.dpi = high / PANEL_IN
        pitch = max(wide, self._pixels(NARROWEST_IN)) + self._pixels(GAP_IN)
        left = self._pixels(LEFT_IN) + (pitch - self._pixels(GAP_IN) - wide) // 2
        top = self._pixels(CLOCK_IN + NAME_IN + LEGEND_IN)
        # a film's frames are of even numbers of pixels
        rows, columns = (
            length + length % 2
            for length in (
                top + high + self._pixels(BOTTOM_IN),
                self._pixels(LEFT_IN + RIGHT_IN) + pitch * len(names) - self._pixels(GAP_IN),
            )
        )
        self.shape = (rows, columns)
        corners = [(top, left + number * pitch) for number in range(len(names))]
        self.panels = [(slice(row, row + high), slice(column, column + wide)) for row, column in corners]
        self.figure = Figure(figsize=(columns / self.dpi, rows / self.dpi), dpi=self.dpi)
        self.figure.set_layout_engine("none")
        self.axes = [self._axes(panel, canvas) for panel in self.panels]
        for axes, name in zip(self.axes, names, strict=True):
            axes.set_title(name, fontsize=NAME_POINTS, pad=72 * LEGEND_IN)
            axes.tick_params(labelleft=axes is self.axes[0])
        self.axes[0].set_ylabel("z [m]")
        self.glyphs = {character: self._glyph(character) for character in CLOCK_CHARACTERS}
        self.image = np.empty((rows, columns, 3), np.uint8)

    def _pixels(self, inches: float) -> int:
        return round(inches * self.dpi)

    def _axes(self, panel: tuple[slice, slice], canvas: Canvas) -> Axes:
        rows, columns = self.shape
        (row, column), (width, height) = (panel[0].stop, panel[1].start), canvas.size_m
        box = (
            column / columns,
            1 - row / rows,
            canvas.shape[1] / columns,
            canvas.shape[0] / rows,
        )
        axes = self.figure.add_axes(box)
        axes.set(xlabel="x [m]", xlim=(0, width), ylim=(0, height))
        axes.set_xticks([0, width], ["0", f"{width:g}"])
        first, last = axes.get_xticklabels()  # within the panel, clear of the next one's
        first.set_horizontalalignment("left")
        last.set_horizontalalignment("right")
        close_frame(axes)
        for spine in axes.spines.values():
            spine.set_linewidth(2 * 72 / self.dpi)  # two pixels: the picture hides the inner one
        return axes

    def _glyph(self, character: str) -> NDArray[np.uint8]:
        """A character of the clock, black on white; all are equally wide."""
        size = 0.63 * CLOCK_POINTS / 72, CLOCK_IN
        figure = Figure(figsize=size, dpi=self.dpi)
        figure.set_layout_engine("none")
        figure.text(0.5, 0.4, character, ha="center", va="center", size=CLOCK_POINTS, family=CLOCK_FONT)
        return _pixels_of(figure)

    def legend(self, number: int, entries: list[tuple[str, str]]) -> None:
        """Write coloured words between the name of a panel and its picture.

        Parameters
        ----------
        number : int
            Of the panel, from 0.
        entries : list of (str, str)
            Word and colour, from left to right.
        """
        for at, (word, colour) in enumerate(entries):
            self.axes[number].text(
                (at + 0.5) / len(entries), 1 + 0.4 * LEGEND_IN / PANEL_IN, word, color=colour,
                transform=self.axes[number].transAxes, ha="center", va="center", size=LEGEND_POINTS,
                weight="bold",
            )  # fmt: skip

    def colour_bar(self, number: int, colour_map: str, limits: tuple[float, float]) -> None:
        """Draw a colour bar between the name of a panel and its picture, with the limits beside it.

        Parameters
        ----------
        number : int
            Of the panel, from 0.
        colour_map : str
            Name in Matplotlib.
        limits : (float, float)
            Values of the first and of the last colour.
        """
        height = LEGEND_IN / PANEL_IN
        bar = self.axes[number].inset_axes((0.25, 1 + 0.2 * height, 0.5, 0.4 * height))
        bar.imshow(np.linspace(0, 1, 256)[None], cmap=colour_map, aspect="auto")
        bar.set(xticks=[], yticks=[])
        for at, align, value in ((0.22, "right", limits[0]), (0.78, "left", limits[1])):
            self.axes[number].text(
                at, 1 + 0.4 * height, f"{value:g}", transform=self.axes[number].transAxes,
                ha=align, va="center", size=LEGEND_POINTS,
            )  # fmt: skip

    def draw(self) -> None:
        """Draw everything that does not move: once, before the first picture."""
        self.image[:] = _pixels_of(self.figure)

    def paint(self, number: int, picture: NDArray[np.uint8]) -> None:
        """Paint the picture of a panel.

        Parameters
        ----------
        number : int
            Of the panel, from 0.
        picture : (rows, columns, 3) uint8 array
            The first row is the lowest.
        """
        self.image[self.panels[number]] = picture[::-1]

    def show_time(self, time_s: float) -> None:
        """Paint the clock, above the middle of the panels."""
        clock = np.concatenate([self.glyphs[character] for character in f"{time_s:.3f} s"], axis=1)
        first = (self.panels[0][1].start + self.panels[-1][1].stop - clock.shape[1]) // 2
        first = max(0, min(first, self.shape[1] - clock.shape[1]))
        self.image[: clock.shape[0], first : first + clock.shape[1]] = clock


def _pixels_of(figure: Figure) -> NDArray[np.uint8]:
    canvas = FigureCanvasAgg(figure)
    canvas.draw()  # type: ignore[no-untyped-call]
    pixels = canvas.buffer_rgba()  # type: ignore[no-untyped-call]
    return np.asarray(pixels)[:, :, :3].copy()
