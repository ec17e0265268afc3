# SPDX-License-Identifier: GPL-3.0-or-later
"""What every test of a figure needs: where its files go, and that they are there and no blank page."""

import matplotlib.image
import pandas as pd

from bedchain.figures.style import FigureFiles

DPI = 80
COLOURS = {"dem": "#222222", "static": "#ee6677", "dynamic": "#4477aa"}
# a blank page has one colour; text, axes and data of the smallest figure have far more ink
LEAST_INK = 0.01


def outputs(folder, name):
    """Files of a figure."""
    return FigureFiles(*(folder / f"{name}.{form}" for form in ("png", "pdf", "csv")), DPI)


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
