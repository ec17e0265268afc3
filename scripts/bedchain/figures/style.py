# SPDX-License-Identifier: GPL-3.0-or-later
"""Style of all figures: column widths of a journal, fonts, colours, and files as vectors and pixels."""

import textwrap
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.collections import EllipseCollection, QuadMesh
from matplotlib.colors import Colormap, Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

from bedchain.files import atomic_file
from bedchain.trajectory.grid import Grid

matplotlib.use("Agg")


SINGLE_COLUMN_IN = 3.5
DOUBLE_COLUMN_IN = 7.2
LINE_COLOUR = "#555555"
EMPTY_COLOUR = "#ffffff"
# letters of a footnote over an inch of the page
FOOTNOTE_SIZE, LETTERS_PER_IN = 6.5, 18.5
# a map of a bed is at most this many times as high as wide; narrow beds are cut off above
MOST_SLENDER = 8.0
STYLE: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.labelsize": 8,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "legend.fontsize": 7,
    "legend.frameon": False,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "lines.linewidth": 1.2,
    "pdf.fonttype": 42,
    "svg.fonttype": "none",
    "figure.constrained_layout.use": True,
    "image.cmap": "cividis",
}


@contextmanager
def figure_style() -> Iterator[None]:
    """Style of every figure, within a ``with`` block; open figures are closed after it."""
    with matplotlib.rc_context(STYLE):
        try:
            yield
        finally:
            plt.close("all")


@dataclass(frozen=True)
class FigureFiles:
    """Files of a figure to make.

    Attributes
    ----------
    png, pdf : Path
        The figure in two forms.
    csv : Path
        Numbers behind it.
    resolution_dpi : int
        Of the png, and of pixels inside the pdf [dots per inch].
    """

    png: Path
    pdf: Path
    csv: Path
    resolution_dpi: int

    def save(self, figure: Figure) -> None:
        """Save a figure in both forms; see `save_figure`."""
        save_figure(figure, self.png, self.pdf, self.resolution_dpi)


def save_figure(figure: Figure, png: Path, pdf: Path, resolution_dpi: int) -> None:
    """Save a figure as png and pdf, each complete or not at all.

    Parameters
    ----------
    figure : Figure
    png, pdf : Path
        Files to make; without dates, so that the same data make the same file.
    resolution_dpi : int
        Of the png, and of images in the pdf [dots per inch].
    """
    if layout := figure.get_layout_engine():
        layout.execute(figure)
    # the layout was just worked out, for both forms: with any engine, also "none", each is drawn twice
    with matplotlib.rc_context({"figure.constrained_layout.use": False}):
        figure.set_layout_engine(None)
        for target, metadata in ((png, {"Software": None}), (pdf, {"CreationDate": None})):
            with atomic_file(target) as temporary:
                figure.savefig(temporary, dpi=resolution_dpi, metadata=metadata)


def label_parts(axis: Axis, parts: tuple[float, ...]) -> None:
    """Ticks of a logarithmic axis at these parts of each decade, as plain numbers."""
    axis.set_major_locator(LogLocator(subs=parts))
    axis.set_major_formatter("{x:g}")
    axis.set_minor_locator(NullLocator())


def footnote(figure: Figure, text: str) -> None:
    """A line below a figure that defines what its labels name; the layout makes room for it."""
    width = int(LETTERS_PER_IN * figure.get_figwidth())
    wrapped = textwrap.fill(" ".join(text.split()), width).replace("$", r"\$")
    note = figure.legend(
        [], [], title=wrapped, loc="outside lower left", alignment="left", borderpad=0.0, borderaxespad=0.2
    )
    note.get_title().set_fontsize(FOOTNOTE_SIZE)
    note.get_title().set_color(LINE_COLOUR)


def map_colours(name: str) -> Colormap:
    """Colour map with the white of the page for missing values."""
    return plt.get_cmap(name).with_extremes(bad=EMPTY_COLOUR)


def draw_cells(axes: Axes, values: np.ndarray, grid: Grid, norm: Normalize, colours: Colormap) -> QuadMesh:
    """Map of the values of cells, in the proportions of the bed; cells with 0 are white (`Grid.projection`).

    Parameters
    ----------
    axes : Axes
    values : (n_cells,) ndarray
        By cell number.
    grid : Grid
    norm : Normalize
    colours : Colormap

    Returns
    -------
    QuadMesh
        For a colour bar.
    """
    table = np.ma.masked_less_equal(grid.projected(values).reshape(grid.rows, grid.columns), 0)
    mesh = axes.pcolormesh(
        grid.x_edges_m, grid.z_edges_m, table, norm=norm, cmap=colours, rasterized=True, linewidth=0
    )
    axes.set_aspect("equal")
    return mesh


def draw_particles(
    axes: Axes, x: np.ndarray, z: np.ndarray, diameter: float, **style: object
) -> EllipseCollection:
    """Particles as circles of their true size.

    Parameters
    ----------
    axes : Axes
    x, z : (n_particles,) ndarray
        Centres [m].
    diameter : float
        Diameter [m].
    **style
        Of `matplotlib.collections.EllipseCollection`.

    Returns
    -------
    EllipseCollection
    """
    size = np.full(len(x), diameter)
    circles = EllipseCollection(
        size, size, np.zeros(len(x)), units="xy", offsets=np.column_stack([x, z]),
        offset_transform=axes.transData, rasterized=len(x) > 2000, **style,
    )  # fmt: skip
    axes.add_collection(circles)
    axes.set_aspect("equal")
    return circles


def close_frame(axes: Axes, open_top: bool = True) -> None:
    """Draw the walls of the bed: left, right and bottom, and the top if it is closed."""
    for side, shown in (("left", True), ("bottom", True), ("right", True), ("top", not open_top)):
        axes.spines[side].set_visible(shown)
        axes.spines[side].set_color(LINE_COLOUR)


def shown_height(cells: np.ndarray, grid: Grid, margin_rows: int = 1) -> float:
    """Height of the highest cell that is not empty, rounded up to a row and with a margin [m].

    Parameters
    ----------
    cells : integer array
        Numbers of the cells that are not empty.
    grid : Grid
    margin_rows : int
        Empty rows above it.

    Returns
    -------
    float
        At most the bed's height [m].
    """
    top = int(grid.indices(cells)[1].max()) + 1 + margin_rows
    return min(top, grid.rows) * grid.cell_height_m
